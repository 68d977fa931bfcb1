// Cube map of a point light: the direction from the light chooses face and texel. The depth that the face's projection
// gives to its largest component is compared with the map; 1 lit, 0 shadowed, between them
// what GL_LINEAR makes of four comparisons, across seams too.
uniform vec2 face_depth_@; // r = x - y / depth
#ifdef SEAMS_@
uniform float seam_@; // of the largest component: from here on a lookup reaches the next face
#endif

#ifdef KERNEL_@
// Taps one texel apart along the axes of the face; beyond its sides the way itself leads onto the next.
vec3 way_@ = vec3(0.0);      // from the light, along the world's axes
vec3 s_@ = vec3(0.0);        // one texel along the face's s
vec3 t_@ = vec3(0.0);        // one texel along its t
float reference_@ = 0.0;

float compare_tap_@(vec2 tap)
{
    vec3 at = way_@ + (FIRST_TAP_@ + tap.x) * s_@ + (FIRST_TAP_@ + tap.y) * t_@;
    return texture(shadow_map_@, vec4(at, reference_@));
}
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
    vec3 texel = vec3(2.0 * largest / float(textureSize(shadow_map_@, 0).x), 0.0, 0.0);
    way_@ = way;
    s_@ = size.x == largest ? texel.yxy : texel.xyy;
    t_@ = size.x == largest || size.y == largest ? texel.yyx : texel.yxy;
    reference_@ = reference;
    return percentage_closer_@();
#else
    return texture(shadow_map_@, vec4(way, reference));
#endif
}
