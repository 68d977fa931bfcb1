// Adaptive bias as GL_NEAREST would choose the texels: one at each tap.
vec3 at_@ = vec3(0.0);    // (s/q, t/q, r/q)
vec2 size_@ = vec2(0.0);  // of the map, in texels
vec2 first_@ = vec2(0.0); // the first tap's texel centre, in texels

float compare_tap_@(vec2 tap)
{
    return compare_@(first_@ + tap, at_@, size_@);
}

float shade_@()
{
    at_@ = light_coord_@.xyz / light_coord_@.w;
    size_@ = vec2(textureSize(shadow_map_@, 0));
    first_@ = floor(at_@.xy * size_@ + FIRST_TAP_@) + 0.5;
    return percentage_closer_@();
}
