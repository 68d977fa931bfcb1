#ifdef DECAL
uniform sampler2D decal_map;
#endif
#ifdef GLOSS_MAP
uniform sampler2D gloss_map;
#endif
#ifdef VERTEX_COLORS
in vec3 own_vertex_color;
#endif

EXACT out vec4 fragment;

void main()
{
    EXACT Lit lit = Lit(scene_ambient, vec3(0.0), vec3(0.0));
#ifdef ANY_LIGHT
    Surface surface = surface_here();
    ILLUMINATE(surface, lit)
#endif
#ifdef SPECULAR_ALONE
    EXACT vec3 color = vec3(0.0);
#elif defined(ADDED)
    EXACT vec3 color = lit.diffuse; // ambient light is there
#else
    EXACT vec3 color = lit.ambient + lit.diffuse;
#endif
#ifdef DECAL
    vec4 decal = texture(decal_map, DECAL_ST);
    color *= decal.rgb;
#endif
#ifdef VERTEX_COLORS
    color *= own_vertex_color;
#endif
#ifdef SPECULAR
#ifdef GLOSS_DECAL
    lit.specular *= decal.a;
#elif defined(GLOSS_MAP)
    lit.specular *= texture(gloss_map, st).GLOSS_MAP;
#endif
    color += lit.specular;
#endif
#ifdef PHOTOGRAPH
    vec4 photo = vec4(0.0);
    PHOTOGRAPH(photo, eye_position)
    if (photo.a > 0.0)
#ifdef PHOTO_THERE
        color = vec3(0.0); // no light falls on it
#else
        color = photo.rgb;
#endif
#endif
    fragment = vec4(color, 1.0);
    // Last: derivatives are undefined where a neighbour was discarded before [GLSL 4.60, 6.4].
    alpha_test();
}
