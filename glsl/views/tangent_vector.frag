// The vector to light @, or the half-angle vector, in the surface's tangent space as a colour: of unit length, v / 2 + 1 / 2.
#ifdef NO_BASES
#define TANGENT_VECTOR vec3(0.0)
#else
in vec3 tangent_light_@;
#ifdef SPECULAR
in vec3 tangent_half_@;
#define TANGENT_VECTOR tangent_half_@
#else
#define TANGENT_VECTOR tangent_light_@
#endif
#endif

out vec4 fragment;

void main()
{
    alpha_test();
    vec3 v = TANGENT_VECTOR;
    vec3 way = abs(v);
    float most = max(way.x, max(way.y, way.z));
    fragment = vec4(most > 0.0 ? 0.5 * normalize(v / most) + 0.5 : vec3(0.0), 1.0);
}
