// What modulates light @ over its cross-section and along its axis [Segal 1992, 3.2]: its image, its beam, its law of distance.
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
#ifdef IMAGE_GRADIENT_@
vec2 image_st_@, image_dx_@, image_dy_@;
#endif

// Called before any branch, where derivatives are defined.
void find_image_@()
{
#ifdef IMAGE_GRADIENT_@
    // By the rule for quotients, at this fragment's own q: a neighbour's may be 0 or below.
    vec3 coord = frustum_coord_@();
    image_st_@ = coord.xy / coord.z;
    vec3 dx = dFdx(coord) / coord.z;
    vec3 dy = dFdy(coord) / coord.z;
    image_dx_@ = dx.xy - image_st_@ * dx.z;
    image_dy_@ = dy.xy - image_st_@ * dy.z;
#endif
}

vec3 projected_@()
{
#ifdef IMAGE_GRADIENT_@
    vec3 beam = textureGrad(spot_image_@, image_st_@, image_dx_@, image_dy_@).rgb;
#elif defined(SPOT_IMAGE_@)
    vec3 beam = textureProj(spot_image_@, frustum_coord_@()).rgb;
#else
    vec3 beam = vec3(1.0);
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
    return beam;
}
