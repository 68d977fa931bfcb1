// Adds light @ [LEC, "Advice for Shadowed Illumination Model"]:
// diffuse by diffuseShade = dimming + (1 - dimming) shade, specular by shade.
#ifdef DIMMING_@
uniform float dimming_@;
#endif
#ifdef DIFFUSE_WEIGHT_@
uniform float diffuse_weight_@;
#endif

void illuminate_@(Surface surface, EXACT inout Lit lit)
{
    Lit own = lighting_@(surface);
    lit.ambient += own.ambient;
#ifdef SIDE_@
    float side = side_@();
    own.diffuse *= side;
    own.specular *= side;
#endif
#ifdef DERIVATIVES_@
    derive_shade_@();
#endif
#ifdef PROJECTED_@
    find_image_@();
#endif
    if (!in_reach_@())
        return;
    float shade = shade_@();
#ifdef DIMMING_@
    float diffuse_shade = dimming_@ + (1.0 - dimming_@) * shade;
#else
    float diffuse_shade = shade;
#endif
#ifdef DIFFUSE_WEIGHT_@
    diffuse_shade *= diffuse_weight_@;
#endif
#ifdef PROJECTED_@
    vec3 beam = projected_@();
#else
    const vec3 beam = vec3(1.0);
#endif
    lit.diffuse += diffuse_shade * beam * own.diffuse;
#ifdef SPECULAR
    lit.specular += shade * beam * own.specular;
#endif
}
