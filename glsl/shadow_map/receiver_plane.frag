// Percentage-closer filtering with a reference on the receiver's own plane at each tap [Isidoro 2006], moved towards the
// light by what that plane falls away within the reach of the tap's filter.
uniform sampler2DShadow shadow_map_@;
uniform float filter_reach_@; // of one tap along each axis, in texels
uniform float towards_light_@; // 1, or -1 where depth is reversed

float shade_@()
{
    vec3 at = light_coord_@.xyz / light_coord_@.w;
    vec2 size = vec2(textureSize(shadow_map_@, 0));
    vec2 slope = receiver_slope_@ / size;
    float reach = towards_light_@ * filter_reach_@ * (abs(slope.x) + abs(slope.y));
    vec2 here = at.xy * size;
    const float FIRST = 0.5 * float(1 - KERNEL_@);
    float lit = 0.0;
    for (int y = 0; y < KERNEL_@; ++y)
        for (int x = 0; x < KERNEL_@; ++x) {
            vec2 tap = here + FIRST + vec2(x, y);
#ifndef PARALLEL_@
            // Beyond the frustum the texels beside it are met, and met where they lie.
            tap = clamp(tap, vec2(0.5), size - 0.5);
#endif
            // Not behind the receiver: beyond its facet its plane is no surface, and the next may fall away by less.
            float along = towards_light_@ * min(towards_light_@ * dot(slope, tap - here), 0.0);
            float reference = clamp(at.z + along - reach, 0.0, 1.0);
            lit += texture(shadow_map_@, vec3(tap / size, reference));
        }
    return lit / float(KERNEL_@ * KERNEL_@);
}
