// A point light's cube map [Hardware Shadow Mapping; techniques A16]: the way from the light chooses face and texel, and
// is compared with the depth that the face's projection gives to its largest component; 1 lit, 0 shadowed, between them
// what GL_LINEAR makes of four comparisons, across seams too.
uniform samplerCubeShadow shadow_map_@;
uniform vec2 face_depth_@; // r = x - y / depth
#ifdef LINEAR_@
uniform float seam_@; // of the largest component: from here on a lookup reaches the next face
#endif

float shade_@()
{
    vec3 way = light_coord_@.xyz; // along the world's axes
    vec3 size = abs(way);
    float depth = max(size.x, max(size.y, size.z));
#ifdef LINEAR_@
    // The next face has its depths along another axis: the reference must not lie behind along any that is met.
    vec3 met = mix(vec3(depth), size, greaterThanEqual(size, vec3(seam_@ * depth)));
    depth = min(met.x, min(met.y, met.z));
#endif
    // Beyond near and far planes as fixed-point maps do it, whatever the format [GL 4.6, 8.23.1].
    return texture(shadow_map_@, vec4(way, clamp(face_depth_@.x - face_depth_@.y / depth, 0.0, 1.0)));
}
