// Planar distance of each sample from the light, r/q [HSM, Figure 4, middle].
out vec4 fragment;

void main()
{
    alpha_test();
    bool reached = in_reach_@();
    fragment = reached ? vec4(vec3(light_coord_@.z / light_coord_@.w), 1.0) : vec4(0.0);
}
