// How r/q changes with (s/q, t/q) on the receiver's own plane, from the fragment's neighbours: exact, since a plane seen
// through a projection is a plane.
vec2 receiver_slope_@ = vec2(0.0);

// Before any branch: derivatives are not defined within one.
void derive_shade_@()
{
    vec4 coord = light_coord_@;
    vec3 at = coord.xyz / coord.w;
    // Over q, so that no product depends on the scene's unit: its square may be too large or too small for a float.
    vec4 dx = dFdx(coord) / coord.w;
    vec4 dy = dFdy(coord) / coord.w;
    vec3 a = dx.xyz - at * dx.w; // along the plane, after projection
    vec3 b = dy.xyz - at * dy.w;
    float area = a.x * b.y - a.y * b.x;
    // Edge-on from the light there is no slope, and no light either.
    receiver_slope_@ = area == 0.0 ? vec2(0.0) : vec2(a.z * b.y - b.z * a.y, a.x * b.z - b.x * a.z) / area;
}
