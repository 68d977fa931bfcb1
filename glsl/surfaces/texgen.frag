// What light/texgen.vert generated for light @, interpolated; divided by q where it is looked up.
#if defined(OVER_W_@)
// Linear in the picture, as a rasterizer without perspective has it [Segal 1992, Equations 7 and 8]: (s, t, r, q) / w, which
// times w is (s, t, r, q) with perspective. gl_FragCoord.w is 1 / w.
noperspective in vec4 light_coord_over_w_@;
#define light_coord_@ (light_coord_over_w_@ / gl_FragCoord.w)
#elif defined(AFFINE_@)
noperspective in vec4 light_coord_@;
#else
in vec4 light_coord_@;
#endif
