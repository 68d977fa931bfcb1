// Adaptive bias [Dou 2014]: each texel is compared with the receiver's own plane where the light's ray through the
// texel's centre meets it. GL_LINEAR's one reference cannot be right for four texels, so the texels are read one by one
// (GL_NEAREST), and its weights are applied here.
uniform sampler2DShadow shadow_map_@;
uniform float towards_light_@; // 1, or -1 where depth is reversed

float compare_@(vec2 centre, vec3 at, vec2 size)
{
#ifndef PARALLEL_@
    // Beyond the frustum the texel beside it is met, and met where it lies.
    centre = clamp(centre, vec2(0.5), size - 0.5);
#endif
    vec2 texture_coord = centre / size;
    // Beyond its facet the receiver's plane is no surface: where it falls away from the light, the next facet may not.
    float along = dot(receiver_slope_@, texture_coord - at.xy);
    float reference = at.z + towards_light_@ * min(towards_light_@ * along, 0.0);
    return texture(shadow_map_@, vec3(texture_coord, clamp(reference, 0.0, 1.0)));
}

#ifdef LINEAR_@
// A row of texels from `first` on, by the sum of GL_LINEAR's taps in it. a + p (b - a) is a where both are equal.
float row_@(vec2 first, float part, vec3 at, vec2 size)
{
    float lit = 0.0;
    float last = compare_@(first, at, size);
    for (int x = 1; x <= KERNEL_@; ++x) {
        float next = compare_@(first + vec2(x, 0), at, size);
        lit += last + part * (next - last);
        last = next;
    }
    return lit;
}
#endif

float shade_@()
{
    vec3 at = light_coord_@.xyz / light_coord_@.w;
    vec2 size = vec2(textureSize(shadow_map_@, 0));
    const float FIRST = 0.5 * float(1 - KERNEL_@);
    float lit = 0.0;
#ifdef LINEAR_@
    vec2 place = at.xy * size - 0.5 + FIRST;
    vec2 first = floor(place) + 0.5;
    vec2 part = fract(place);
    float last = row_@(first, part.x, at, size);
    for (int y = 1; y <= KERNEL_@; ++y) {
        float next = row_@(first + vec2(0, y), part.x, at, size);
        lit += last + part.y * (next - last);
        last = next;
    }
#else
    vec2 first = floor(at.xy * size + FIRST) + 0.5;
    for (int y = 0; y < KERNEL_@; ++y)
        for (int x = 0; x < KERNEL_@; ++x)
            lit += compare_@(first + vec2(x, y), at, size);
#endif
    return lit / float(KERNEL_@ * KERNEL_@);
}
