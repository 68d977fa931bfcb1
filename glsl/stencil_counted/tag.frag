// The stencil buffer is told of light @'s shadow by the fragments that are left [lecture, "Combining Shadow Mapping with
// other Techniques"; techniques A20]. A tag is one bit: a filtered shade of one half or more is lit.
void main()
{
#ifdef ALPHA_TEST
    alpha_test();
#endif
#ifdef DERIVATIVES_@
    derive_shade_@();
#endif
    bool reached = in_reach_@();
    if (!reached || shade_@() >= 0.5)
        discard;
}
