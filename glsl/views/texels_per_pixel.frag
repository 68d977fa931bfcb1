// Side of the square of map texels that one pixel of this picture covers [HSM, Figure 6].
#ifdef CUBE_@
uniform samplerCube counted_map_@;
#else
uniform sampler2D counted_map_@;
#endif

out vec4 fragment;

// The area in texels, from how the coordinates change to the neighbours, by the rule for quotients: exact at seams too.
// Each is divided by q before they meet, so that no product depends on the scene's unit.
float texels_@()
{
    vec4 dx = dFdx(light_coord_@);
    vec4 dy = dFdy(light_coord_@);
#ifdef CUBE_@
    // The face's two axes, over its own.
    vec3 size = abs(light_coord_@.xyz);
    ivec3 axes = size.x >= size.y && size.x >= size.z ? ivec3(1, 2, 0) : size.y >= size.z ? ivec3(2, 0, 1) : ivec3(0, 1, 2);
    float q = light_coord_@[axes.z];
    vec2 at = vec2(light_coord_@[axes.x], light_coord_@[axes.y]) / q;
    vec2 a = (vec2(dx[axes.x], dx[axes.y]) - at * dx[axes.z]) / q;
    vec2 b = (vec2(dy[axes.x], dy[axes.y]) - at * dy[axes.z]) / q;
    vec2 texels = 0.5 * vec2(textureSize(counted_map_@, 0));
#else
    float q = light_coord_@.w;
    vec2 at = light_coord_@.xy / q;
    vec2 a = (dx.xy - at * dx.w) / q;
    vec2 b = (dy.xy - at * dy.w) / q;
    vec2 texels = vec2(textureSize(counted_map_@, 0));
#endif
    return abs(a.x * b.y - a.y * b.x) * texels.x * texels.y;
}

void main()
{
    float area = texels_@();
    alpha_test();
    bool reached = in_reach_@();
    fragment = reached ? vec4(vec3(sqrt(area)), 1.0) : vec4(0.0);
}
