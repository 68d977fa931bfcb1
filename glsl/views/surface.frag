// A property of the surfaces as a colour: their normals in world space, their normal maps, decals or gloss maps.
#ifdef SHOW_NORMAL
uniform mat3 world_from_eye;
#endif
#ifdef SHOW_NORMAL_MAP
uniform sampler2D normal_map;
#endif
#ifdef DECAL
uniform sampler2D decal_map;
#endif
#ifdef SHOW_DECAL
uniform vec3 own_color;
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
    vec3 color = vec3(1.0);
#ifdef SHOW_NORMAL
    vec3 normal = world_from_eye * surface_here().normal;
    color = 0.5 * normal / max(length(normal), 1e-30) + 0.5;
#endif
#ifdef SHOW_NORMAL_MAP
    color = texture(normal_map, st).rgb;
#ifdef NORMAL_SIGNED
    color = 0.5 * color + 0.5;
#endif
#endif
#ifdef SHOW_FLAT
    color = vec3(0.5, 0.5, 1.0);
#endif
#ifdef SHOW_DECAL
    color = own_color;
#ifdef DECAL
    color *= texture(decal_map, DECAL_ST).rgb;
#endif
#ifdef VERTEX_COLORS
    color *= own_vertex_color;
#endif
#endif
#ifdef GLOSS_DECAL
    color = vec3(texture(decal_map, DECAL_ST).a);
#elif defined(GLOSS_MAP)
    color = vec3(texture(gloss_map, st).GLOSS_MAP);
#endif
    fragment = vec4(color, 1.0);
    // Last: derivatives are undefined where a neighbour was discarded before [GLSL 4.60, 6.4].
    alpha_test();
}
