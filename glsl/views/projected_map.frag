// Depths of the map, projected onto the scene [HSM, Figure 4, right].
uniform sampler2D depth_map_@;

out vec4 fragment;

void main()
{
    alpha_test();
    bool reached = in_reach_@();
    fragment = reached ? vec4(vec3(textureProj(depth_map_@, light_coord_@.xyw).r), 1.0) : vec4(0.0);
}
