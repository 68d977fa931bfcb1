// The planar texgen of light @'s plane [LEC, "Careful about Back Projecting Shadow Maps"]: q times a power of
// two, which rounds as q does. Values below 1/2 are behind the light, or on its plane.
uniform vec4 side_plane_@;

out float side_s_@;

void find_side_@(vec4 eye)
{
    side_s_@ = dot(side_plane_@, eye);
}
