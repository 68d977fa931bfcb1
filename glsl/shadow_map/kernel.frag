// Percentage-closer filtering by KERNEL_@ x KERNEL_@ comparisons of the texture unit, one texel apart, each weighted alike
// [Reeves 1987; LEC, "Hardware Shadow Map Filtering"]. With GL_LINEAR each of them is four, so that the
// weights are a box's and a tent's together.
uniform sampler2DShadow shadow_map_@;

float shade_@()
{
    vec3 at = light_coord_@.xyz / light_coord_@.w;
#ifdef CLAMP_REFERENCE_@
    at.z = clamp(at.z, 0.0, 1.0);
#endif
    vec2 texel = 1.0 / vec2(textureSize(shadow_map_@, 0));
    const float FIRST = 0.5 * float(1 - KERNEL_@);
    float lit = 0.0;
    for (int y = 0; y < KERNEL_@; ++y)
        for (int x = 0; x < KERNEL_@; ++x)
            lit += texture(shadow_map_@, vec3(at.xy + (FIRST + vec2(x, y)) * texel, at.z));
    return lit / float(KERNEL_@ * KERNEL_@);
}
