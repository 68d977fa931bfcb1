in vec2 st;

// Where the surface's textures lie on its coordinates (MTL's -s and -o): scale in xy, offset in zw.
#ifdef DECAL_PLACED
uniform vec4 decal_placement;
#define DECAL_ST (decal_placement.xy * st + decal_placement.zw)
#else
#define DECAL_ST st
#endif
#ifdef ALPHA_PLACED
uniform vec4 alpha_placement;
#define ALPHA_ST (alpha_placement.xy * st + alpha_placement.zw)
#else
#define ALPHA_ST st
#endif
