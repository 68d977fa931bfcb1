// Adds light @ [LEC, "Advice for Shadowed Illumination Model"]:
// diffuse by diffuseShade = dimming + (1 - dimming) shade, specular by shade.
#ifdef SPOT_IMAGE_@
uniform sampler2D spot_image_@;
#endif
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
#ifdef IMAGE_GRADIENT_@
    // Before any branch, where derivatives are defined. By the rule for quotients, at this fragment's own q: a neighbour's
    // may be 0 or below.
    vec3 image_coord = frustum_coord_@();
    vec2 image_st = image_coord.xy / image_coord.z;
    vec3 image_dx = dFdx(image_coord) / image_coord.z;
    vec3 image_dy = dFdy(image_coord) / image_coord.z;
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
#ifdef IMAGE_GRADIENT_@
    vec3 beam = textureGrad(spot_image_@, image_st, image_dx.xy - image_st * image_dx.z,
                            image_dy.xy - image_st * image_dy.z).rgb;
#elif defined(SPOT_IMAGE_@)
    vec3 beam = textureProj(spot_image_@, frustum_coord_@()).rgb;
#else
    const vec3 beam = vec3(1.0);
#endif
    lit.diffuse += diffuse_shade * beam * own.diffuse;
#ifdef SPECULAR
    lit.specular += shade * beam * own.specular;
#endif
}
