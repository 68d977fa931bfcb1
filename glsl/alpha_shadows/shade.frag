// The shade of light @ in alpha, 0 where it does not reach [Segal 1992, 3.3]. No colour is written.
out vec4 fragment;

void main()
{
#ifdef DERIVATIVES_@
    derive_shade_@();
#endif
    bool reached = in_reach_@();
    fragment = vec4(vec3(0.0), reached ? shade_@() : 0.0);
    // Last: derivatives are undefined where a neighbour was discarded before [GLSL 4.60, 6.4].
#ifdef ALPHA_TEST
    alpha_test();
#endif
}
