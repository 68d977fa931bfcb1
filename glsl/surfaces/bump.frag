// Bumped normal of the point [GDC, "Per-Pixel Lighting Math"]: N' = x T + y B + z N, with x, y and z from the normal map.
in vec3 eye_tangent;
in vec3 eye_bitangent;
uniform sampler2D normal_map;

vec3 smooth_normal = vec3(0.0); // of the surface without bumps: of unit length, in eye space
float bump_dim = 0.0;            // length of the normals that the texel is the mean of; multiplies diffuse light

// normal: interpolated, of any length. smooth_normal is set before; it may be the other way around.
vec3 bumped(vec3 normal)
{
    vec4 texel = texture(normal_map, st);
    bump_dim = texel.a;
#ifdef NORMAL_SIGNED
    vec3 n = texel.rgb;
#else
    vec3 n = 2.0 * texel.rgb - 1.0;
#endif
    EXACT vec3 direction = n.x * eye_tangent + n.y * eye_bitangent + n.z * normal;
    // As long as the texel is: a filter's mean of unit normals is shorter, and dims.
    EXACT vec3 result = length(n) * normalize(direction);
    if (dot(direction, direction) == 0.0)
        return vec3(0.0);
    return dot(smooth_normal, normal) < 0.0 ? -result : result;
}

// Share of the light, or of its highlight, that a vector with this component along the smooth normal leaves.
float above_horizon(float z)
{
#ifdef SELF_SHADOW
    return min(1.0, 8.0 * max(z, 0.0));
#else
    return 1.0;
#endif
}
