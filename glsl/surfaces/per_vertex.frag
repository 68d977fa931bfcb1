// What the vertex stage found for light @.
in vec3 vertex_diffuse_@;
#ifdef LIGHT_AMBIENT_@
in vec3 vertex_ambient_@;
#endif
#ifdef SPECULAR
in vec3 vertex_specular_@;
#endif

Lit lighting_@(Surface surface)
{
    Lit lit;
#ifdef LIGHT_AMBIENT_@
    lit.ambient = vertex_ambient_@;
#else
    lit.ambient = vec3(0.0);
#endif
    lit.diffuse = vertex_diffuse_@;
#ifdef SPECULAR
    lit.specular = vertex_specular_@;
#else
    lit.specular = vec3(0.0);
#endif
    return lit;
}
