// Adds light @ [LEC, "Advice for Shadowed Illumination Model"]:
// diffuse by diffuseShade = dimming + (1 - dimming) shade, specular by shade.
#ifdef SPOT_IMAGE_@
uniform sampler2D spot_image_@;
#endif
#ifdef BEAM_MAP_@
uniform sampler2D beam_map_@;
#endif
#ifdef FALLOFF_@
// A law of the distance along the light's axis, and how a coordinate of it is made: scale, then offset.
uniform sampler1D falloff_@;
uniform vec2 falloff_place_@;
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
#elif defined(BEAM_MAP_@) || defined(FALLOFF_@)
    vec3 beam = vec3(1.0);
#else
    const vec3 beam = vec3(1.0);
#endif
#ifdef BEAM_MAP_@
    beam *= textureProj(beam_map_@, frustum_coord_@()).rgb;
#endif
#ifdef FALLOFF_@
    // q is the distance along the light's axis. Depth in the light's window space, r/q, is linear in 1/q
    // [Segal 1992, 3.2]; made of q it is free of a map's bias and crop.
#ifdef FALLOFF_DEPTH_@
    float falloff_at = falloff_place_@.x / light_coord_@.w + falloff_place_@.y;
#else
    float falloff_at = falloff_place_@.x * light_coord_@.w + falloff_place_@.y;
#endif
    beam *= min(textureLod(falloff_@, falloff_at, 0.0).r, 1.0);
#endif
    lit.diffuse += diffuse_shade * beam * own.diffuse;
#ifdef SPECULAR
    lit.specular += shade * beam * own.specular;
#endif
}
