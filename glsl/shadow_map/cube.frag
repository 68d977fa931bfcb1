// Cube map of a point light: the direction from the light chooses face and texel. The depth that the face's projection
// gives to its largest component is compared with the map; 1 lit, 0 shadowed, between them
// what GL_LINEAR makes of four comparisons, across seams too.
uniform samplerCubeShadow shadow_map_@;
uniform vec2 face_depth_@; // r = x - y / depth
#ifdef SEAMS_@
uniform float seam_@; // of the largest component: from here on a lookup reaches the next face
#endif

float shade_@()
{
    vec3 way = light_coord_@.xyz; // along the world's axes
    vec3 size = abs(way);
    float largest = max(size.x, max(size.y, size.z));
    float depth = largest;
#ifdef SEAMS_@
    // The next face has its depths along another axis: the reference must not lie behind along any that is met.
    vec3 met = mix(vec3(largest), size, greaterThanEqual(size, vec3(seam_@ * largest)));
    depth = min(met.x, min(met.y, met.z));
#endif
    // Beyond near and far planes as fixed-point maps do it, whatever the format [GL 4.6, 8.23.1].
    float reference = clamp(face_depth_@.x - face_depth_@.y / depth, 0.0, 1.0);
#ifdef KERNEL_@
    // Comparisons one texel apart along the axes of the face; beyond its sides the way itself leads onto the next.
    vec3 texel = vec3(2.0 * largest / float(textureSize(shadow_map_@, 0).x), 0.0, 0.0);
    vec3 s = size.x == largest ? texel.yxy : texel.xyy;
    vec3 t = size.x == largest || size.y == largest ? texel.yyx : texel.yxy;
    const float FIRST = 0.5 * float(1 - KERNEL_@);
    float lit = 0.0;
    for (int y = 0; y < KERNEL_@; ++y)
        for (int x = 0; x < KERNEL_@; ++x)
            lit += texture(shadow_map_@, vec4(way + (FIRST + float(x)) * s + (FIRST + float(y)) * t, reference));
    return lit / float(KERNEL_@ * KERNEL_@);
#else
    return texture(shadow_map_@, vec4(way, reference));
#endif
}
