// Adaptive bias with the weights of GL_LINEAR. Neighbouring taps share two of their four texels: each of the
// (KERNEL_@ + 1) x (KERNEL_@ + 1) texels is compared once, and not, as in percentage_closer.glsl, tap by tap.

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

float shade_@()
{
    vec3 at = light_coord_@.xyz / light_coord_@.w;
    vec2 size = vec2(textureSize(shadow_map_@, 0));
    const float FIRST = 0.5 * float(1 - KERNEL_@);
    float lit = 0.0;
    vec2 place = at.xy * size - 0.5 + FIRST;
    vec2 first = floor(place) + 0.5;
    vec2 part = fract(place);
    float last = row_@(first, part.x, at, size);
    for (int y = 1; y <= KERNEL_@; ++y) {
        float next = row_@(first + vec2(0, y), part.x, at, size);
        lit += last + part.y * (next - last);
        last = next;
    }
    return lit / float(KERNEL_@ * KERNEL_@);
}
