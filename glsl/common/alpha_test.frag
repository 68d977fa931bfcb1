// GL_ALPHA_TEST with GL_GEQUAL 0.5: holes in surfaces and, in the map, in their shadows. Of level 0 alone, so that they
// are the same from everywhere.
uniform float opacity;
#ifdef DECAL_ALPHA
uniform sampler2D decal_alpha_map;
#endif
#ifdef ALPHA_MAP
uniform sampler2D alpha_map;
#endif

void alpha_test()
{
    float alpha = opacity;
#ifdef DECAL_ALPHA
    alpha *= texture(decal_alpha_map, DECAL_ST).a;
#endif
#ifdef ALPHA_MAP
    alpha *= texture(alpha_map, ALPHA_ST).ALPHA_MAP;
#endif
    if (alpha < 0.5)
        discard;
}
