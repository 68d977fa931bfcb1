// Second of the three passes [GDC, "Three Passes"]: the decal, and in alpha the gloss, by which the third is weighed.
#ifdef DECAL
uniform sampler2D decal_map;
#endif
#ifdef GLOSS_MAP
uniform sampler2D gloss_map;
#endif
#ifdef VERTEX_COLORS
in vec3 own_vertex_color;
#endif

out vec4 fragment;

void main()
{
#ifdef DECAL
    fragment = texture(decal_map, DECAL_ST);
#else
    fragment = vec4(1.0);
#endif
#ifdef VERTEX_COLORS
    fragment.rgb *= own_vertex_color;
#endif
#ifdef GLOSS_MAP
    fragment.a = texture(gloss_map, st).GLOSS_MAP;
#elif !defined(GLOSS_DECAL)
    fragment.a = 1.0;
#endif
    // Last: derivatives are undefined where a neighbour was discarded before [GLSL 4.60, 6.4].
#ifdef ALPHA_TEST
    alpha_test();
#endif
}
