// Vectors to light @ in the surface's tangent space, interpolated without being of unit length [GDC, "Surface Space"].
#ifdef DIRECTIONAL_@
uniform vec3 light_direction_@; // to the light, of unit length, in eye space
#else
uniform vec3 light_position_@;
#endif
out vec3 tangent_light_@;
#ifdef SPECULAR
out vec3 tangent_half_@;

// Gives a vector unit length, whatever length it has; a zero vector stays one.
vec3 unit_@(vec3 v)
{
    vec3 way = abs(v);
    float most = max(way.x, max(way.y, way.z));
    return most > 0.0 ? normalize(v / most) : vec3(0.0);
}
#endif

// basis: T, B and N by the matrix of normals. A vector's products with them are those that the vector has in model space.
void set_tangent_vectors_@(vec3 eye, mat3 basis)
{
#ifdef DIRECTIONAL_@
    tangent_light_@ = light_direction_@ * basis;
#else
    tangent_light_@ = (light_position_@ - eye) * basis;
#endif
#ifdef SPECULAR
    tangent_half_@ = unit_@(tangent_light_@) + unit_@(-eye * basis);
#endif
}
