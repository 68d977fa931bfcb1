// The planar texgen of light @'s plane [lecture, "Careful about Back Projecting Shadow Maps"; techniques A13 b]: q times a
// power of two, which rounds as q itself does. What is left of 1/2 is behind the light, or on its plane.
uniform vec4 side_plane_@;

out float side_s_@;

void find_side_@(vec4 eye)
{
    side_s_@ = dot(side_plane_@, eye);
}
