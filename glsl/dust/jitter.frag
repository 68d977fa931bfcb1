// Moves each pixel's slices of light @'s beam along the view ray by a share of their distance, so that bands become noise.
// Texture coordinates are linear along the ray from the eye.

// Texture coordinates of the eye.
uniform vec4 coord_of_eye_@;
// Distance of two slices along the view axis, in world units.
uniform float spacing;
// Window depth of a point at distance h along the view axis: x + y / h.
uniform vec2 depth_of_distance;

vec4 placed_coord_@ = vec4(0.0);

// A number in [-1/2, 1/2) of a pixel, without a pattern [Jimenez 2014].
float jitter_here()
{
    return fract(52.9829189 * fract(dot(floor(gl_FragCoord.xy), vec2(0.06711056, 0.00583715)))) - 0.5;
}

void place_slice(float share)
{
    float here = 1.0 / gl_FragCoord.w;
    float there = here + share * spacing;
    placed_coord_@ = coord_of_eye_@ + (light_coord_@ - coord_of_eye_@) * (there / here);
    gl_FragDepth = depth_of_distance.x + depth_of_distance.y / there;
}
#define light_coord_@ placed_coord_@
