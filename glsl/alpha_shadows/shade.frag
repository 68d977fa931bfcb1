// The shade of light @ in alpha, 0 where it does not reach [Segal 1992, 3.3]. No colour is written.
out vec4 fragment;

void main()
{
#ifdef ALPHA_TEST
    alpha_test();
#endif
#ifdef DERIVATIVES_@
    derive_shade_@();
#endif
    bool reached = in_reach_@();
    fragment = vec4(vec3(0.0), reached ? shade_@() : 0.0);
}
