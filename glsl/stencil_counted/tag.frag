// Discards lit fragments of light @; those that are left mark its shadow in the stencil buffer [LEC, "Combining Shadow
// Mapping with other Techniques"]. The mark is one bit: a filtered shade of one half or more is lit.
void main()
{
#ifdef DERIVATIVES_@
    derive_shade_@();
#endif
    alpha_test();
    bool reached = in_reach_@();
    if (!reached || shade_@() >= 0.5)
        discard;
}
