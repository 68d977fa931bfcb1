// Light @'s depth texture. The texture unit compares: 1 lit, 0 shadowed [GL 4.6, 8.23.1].
#ifdef CUBE_@
uniform samplerCubeShadow shadow_map_@;
#else
uniform sampler2DShadow shadow_map_@;
#endif
