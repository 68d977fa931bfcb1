// Bumps in the light of light @ by register combiners, `combine` [GDC, "Same Math in a Single Pass on GeForce3"].
#if defined(EYE_POSITION) && !defined(TWO_SIDED)
in vec3 eye_position;
#endif
#ifdef TWO_SIDED
in vec3 eye_normal;
#endif
uniform sampler2D normal_map;
#ifdef UNIT_VECTORS
uniform samplerCube unit_vectors;
#endif
in vec3 tangent_light_@;
#ifdef SPECULAR
in vec3 tangent_half_@;
#endif
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

// A vector's direction as a colour, v / 2 + 1 / 2.
vec4 direction_color(vec3 v)
{
#ifdef UNIT_VECTORS
    return texture(unit_vectors, v);
#else
    vec3 way = abs(v);
    float most = max(way.x, max(way.y, way.z));
    vec3 unit = most > 0.0 ? normalize(v / most) : vec3(0.0);
    return vec4(0.5 * unit + 0.5, 1.0);
#endif
}

void main()
{
    EXACT Lit lit = Lit(scene_ambient, vec3(0.0), vec3(0.0));
    Surface surface = Surface(vec3(0.0), vec3(0.0), vec3(0.0));
#ifdef EYE_POSITION
    surface.position = eye_position;
#endif
    // Colours of the light, with shade and beam: the surface is not in them yet.
    ILLUMINATE(surface, lit)
    float side = 1.0;
#ifdef TWO_SIDED
    if (seen_from_behind(eye_normal))
        side = -1.0; // every bump is a dent from behind, and the light is on the other side
#endif
    vec4 tex0 = texture(normal_map, st);
#ifdef NORMAL_SIGNED
    tex0.rgb = 0.5 * tex0.rgb + 0.5;
#endif
    vec4 tex1 = direction_color(side * tangent_light_@);
#ifdef SPECULAR
    vec4 tex2 = direction_color(side * tangent_half_@);
#else
    const vec4 tex2 = vec4(0.5, 0.5, 0.5, 1.0);
#endif
#ifdef DECAL
    vec4 tex3 = texture(decal_map, DECAL_ST);
#else
    vec4 tex3 = vec4(1.0);
#endif
#ifdef VERTEX_COLORS
    tex3.rgb *= own_vertex_color;
#endif
#ifdef GLOSS_MAP
    tex3.a = texture(gloss_map, st).GLOSS_MAP;
#elif !defined(GLOSS_DECAL)
    tex3.a = 1.0;
#endif
    // Constants and colours of the combiners are in [0, 1].
#ifdef COLORS_IN_RANGE
#define in_range(color) (color)
#else
#define in_range(color) clamp(color, 0.0, 1.0)
#endif
    vec4 const0 = vec4(in_range(lit.ambient), 1.0);
    vec4 col0 = vec4(in_range(lit.diffuse), 1.0);
    vec4 col1 = vec4(in_range(lit.specular), 1.0);
    fragment = vec4(combine(const0, vec4(0.0), vec4(0.0), col0, col1, tex0, tex1, tex2, tex3).rgb, 1.0);
    // Last: derivatives are undefined where a neighbour was discarded before [GLSL 4.60, 6.4].
    alpha_test();
}
