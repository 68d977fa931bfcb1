// Factors of the slide projector's product, c (ambient + light) [Segal 1992, 3.1]; a pass has one of them or all.
#ifdef EYE_POSITION
in vec3 eye_position;
#endif
#ifdef OWN_COLOR
uniform vec3 own_color;
#endif
#ifdef DECAL
uniform sampler2D decal_map;
#endif
#ifdef VERTEX_COLORS
in vec3 own_vertex_color;
#endif

EXACT out vec4 fragment;

void main()
{
#ifdef AMBIENT_FACTOR
    EXACT Lit lit = Lit(scene_ambient, vec3(0.0), vec3(0.0));
#else
    EXACT Lit lit = Lit(vec3(0.0), vec3(0.0), vec3(0.0));
#endif
#ifdef ANY_LIGHT
    Surface surface = Surface(vec3(0.0), vec3(0.0), vec3(0.0));
#ifdef EYE_POSITION
    surface.position = eye_position;
#endif
    ILLUMINATE(surface, lit)
#endif
#if defined(AMBIENT_FACTOR) || defined(ANY_LIGHT)
    EXACT vec3 color = lit.ambient + lit.diffuse;
#else
    EXACT vec3 color = vec3(1.0);
#endif
#ifdef OWN_COLOR
    color *= own_color;
#endif
#ifdef DECAL
    color *= texture(decal_map, DECAL_ST).rgb;
#endif
#ifdef VERTEX_COLORS
    color *= own_vertex_color;
#endif
#ifdef PHOTOGRAPH
    // A photograph as it is: no light but 1, and its colour in place of the surface's own.
    vec4 photo = vec4(0.0);
    PHOTOGRAPH(photo, eye_position)
    if (photo.a > 0.0)
#if defined(OWN_COLOR)
        color = photo.rgb;
#elif defined(AMBIENT_FACTOR)
        color = vec3(1.0);
#else
        color = vec3(0.0);
#endif
#endif
    fragment = vec4(color, 1.0);
    // Last: derivatives are undefined where a neighbour was discarded before [GLSL 4.60, 6.4].
#ifdef ALPHA_TEST
    alpha_test();
#endif
}
