// The shadow term alone: shade, and alpha 1 where the light reaches.
out vec4 fragment;

void main()
{
#ifdef DERIVATIVES_@
    derive_shade_@();
#endif
    alpha_test();
    bool reached = in_reach_@();
    fragment = reached ? vec4(vec3(shade_@()), 1.0) : vec4(0.0);
}
