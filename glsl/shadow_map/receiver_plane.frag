// Percentage-closer filtering with a reference on the receiver's own plane at each tap [Isidoro 2006], moved towards the
// light by what that plane falls away within the reach of the tap's filter.
uniform float filter_reach_@; // of one tap along each axis, in texels
uniform float towards_light_@; // 1, or -1 where depth is reversed

vec2 size_@ = vec2(0.0);  // of the map, in texels
vec2 here_@ = vec2(0.0);  // the lookup's place, in texels
vec2 slope_@ = vec2(0.0); // of r/q, in one texel along each axis
float depth_@ = 0.0; // r/q
float reach_@ = 0.0; // what is taken off each reference

float compare_tap_@(vec2 tap)
{
    vec2 place = here_@ + FIRST_TAP_@ + tap;
#ifndef PARALLEL_@
    // Beyond the frustum the texels beside it are met, and met where they lie.
    place = clamp(place, vec2(0.5), size_@ - 0.5);
#endif
    // Not behind the receiver: beyond its facet its plane is no surface, and the next may fall away by less.
    float along = towards_light_@ * min(towards_light_@ * dot(slope_@, place - here_@), 0.0);
    float reference = clamp(depth_@ + along - reach_@, 0.0, 1.0);
    return texture(shadow_map_@, vec3(place / size_@, reference));
}

float shade_@()
{
    vec3 at = light_coord_@.xyz / light_coord_@.w;
    size_@ = vec2(textureSize(shadow_map_@, 0));
    slope_@ = receiver_slope_@ / size_@;
    reach_@ = towards_light_@ * filter_reach_@ * (abs(slope_@.x) + abs(slope_@.y));
    here_@ = at.xy * size_@;
    depth_@ = at.z;
    return percentage_closer_@();
}
