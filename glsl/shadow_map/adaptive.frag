// Adaptive bias [Dou et al. 2014]: each texel is compared with the receiver's own plane where the light's ray through the
// texel's centre meets it. GL_LINEAR's one reference cannot be right for four texels, so its weights are applied here.
uniform sampler2DShadow shadow_map_@;

// At a texel's centre GL_LINEAR has the weight of that texel alone.
float compare_@(vec2 centre, vec3 at, vec2 size)
{
    vec2 texture_coord = centre / size;
    float reference = at.z + dot(receiver_slope_@, texture_coord - at.xy);
    return texture(shadow_map_@, vec3(texture_coord, clamp(reference, 0.0, 1.0)));
}

float shade_@()
{
    vec3 at = light_coord_@.xyz / light_coord_@.w;
    vec2 size = vec2(textureSize(shadow_map_@, 0));
    const float FIRST = 0.5 * float(1 - KERNEL_@);
    float lit = 0.0;
#ifdef LINEAR_@
    vec2 place = at.xy * size - 0.5 + FIRST;
    vec2 first = floor(place);
    vec2 part = place - first;
    for (int y = 0; y <= KERNEL_@; ++y)
        for (int x = 0; x <= KERNEL_@; ++x) {
            vec2 weight = vec2(x == 0 ? 1.0 - part.x : x == KERNEL_@ ? part.x : 1.0,
                               y == 0 ? 1.0 - part.y : y == KERNEL_@ ? part.y : 1.0);
            lit += weight.x * weight.y * compare_@(first + vec2(x, y) + 0.5, at, size);
        }
#else
    vec2 first = floor(at.xy * size + FIRST) + 0.5;
    for (int y = 0; y < KERNEL_@; ++y)
        for (int x = 0; x < KERNEL_@; ++x)
            lit += compare_@(first + vec2(x, y), at, size);
#endif
    return lit / float(KERNEL_@ * KERNEL_@);
}
