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
#ifdef FALLOFF_ENTRIES_@

// The law's own table: all distances, then their factors.
float falloff_of_@(float depth)
{
    int count = textureSize(falloff_@, 0) / 2;
    int low = 0;
    int high = count - 1;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (texelFetch(falloff_@, middle, 0).r <= depth)
            low = middle;
        else
            high = middle;
    }
    float from = texelFetch(falloff_@, low, 0).r;
    float range = texelFetch(falloff_@, high, 0).r - from;
    // Distances that are one in float: a step.
    float part = range > 0.0 ? clamp((depth - from) / range, 0.0, 1.0) : float(depth > from);
    return mix(texelFetch(falloff_@, count + low, 0).r, texelFetch(falloff_@, count + high, 0).r, part);
}
#endif
#endif
#ifdef IMAGE_GRADIENT_@
vec2 image_st_@ = vec2(0.0);
vec2 image_dx_@ = vec2(0.0);
vec2 image_dy_@ = vec2(0.0);
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
#ifdef FALLOFF_ENTRIES_@
    beam *= falloff_of_@(clamp(light_coord_@.w, falloff_place_@.x, falloff_place_@.y));
#else
#ifdef FALLOFF_DEPTH_@
    float falloff_at = falloff_place_@.x / light_coord_@.w + falloff_place_@.y;
#elif defined(FALLOFF_LOGARITHM_@)
    float falloff_at = falloff_place_@.x * log2(light_coord_@.w) + falloff_place_@.y;
#else
    float falloff_at = falloff_place_@.x * light_coord_@.w + falloff_place_@.y;
#endif
    beam *= min(textureLod(falloff_@, falloff_at, 0.0).r, 1.0);
#endif
#endif
    return beam;
}
