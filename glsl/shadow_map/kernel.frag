// A kernel of the texture unit's comparisons, all with one reference. With GL_LINEAR each tap is four comparisons, so that
// the weights are a box's and a tent's together.
vec3 centre_@ = vec3(0.0); // (s/q, t/q, r/q)
vec2 texel_@ = vec2(0.0);

float compare_tap_@(vec2 tap)
{
    return texture(shadow_map_@, vec3(centre_@.xy + (FIRST_TAP_@ + tap) * texel_@, centre_@.z));
}

float shade_@()
{
#ifdef NORMAL_OFFSET_@
    vec4 coord = offset_coord_@;
#else
    vec4 coord = light_coord_@;
#endif
    centre_@ = coord.xyz / coord.w;
#ifdef CLAMP_REFERENCE_@
    centre_@.z = clamp(centre_@.z, 0.0, 1.0);
#endif
    texel_@ = 1.0 / vec2(textureSize(shadow_map_@, 0));
    return percentage_closer_@();
}
