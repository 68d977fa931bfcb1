// Light @ on a surface, before shadow and beam: Phong per fragment, or fixed-function per vertex where the vertex
// stage includes this [GL 4.6 compatibility, 12.2].
#ifdef DIRECTIONAL_@
uniform vec3 light_direction_@; // to the light, of unit length, in eye space
#else
uniform vec3 light_position_@;
#endif
#ifdef LIGHT_AMBIENT_@
uniform vec3 light_ambient_@;
#endif
uniform vec3 light_diffuse_@;
#ifdef SPECULAR
uniform vec3 light_specular_@;
#endif
#ifdef ATTENUATION_@
uniform vec3 attenuation_@;
#endif

Lit lighting_@(Surface surface)
{
#ifdef DIRECTIONAL_@
    vec3 l = light_direction_@;
#else
    vec3 to_light = light_position_@ - surface.position;
    float distance_squared = dot(to_light, to_light);
    vec3 l = to_light * inversesqrt(distance_squared);
#endif
#ifdef ATTENUATION_@
    float strength = 1.0 / (attenuation_@.x + attenuation_@.y * sqrt(distance_squared)
                            + attenuation_@.z * distance_squared);
#else
    const float strength = 1.0;
#endif
    EXACT Lit lit;
#ifdef LIGHT_AMBIENT_@
    lit.ambient = strength * light_ambient_@ * material_ambient;
#else
    lit.ambient = vec3(0.0);
#endif
#ifdef COMBINED
    // Register combiners have the surface's part.
    lit.diffuse = strength * light_diffuse_@ * material_diffuse;
#ifdef SPECULAR
    lit.specular = strength * light_specular_@ * material_specular;
#else
    lit.specular = vec3(0.0);
#endif
#elif defined(UNLIT) || defined(NO_COSINE_@)
    lit.diffuse = strength * light_diffuse_@ * material_diffuse;
    lit.specular = vec3(0.0);
#else
    float n_dot_l = dot(surface.normal, l);
    lit.diffuse = strength * max(n_dot_l, 0.0) * light_diffuse_@ * material_diffuse;
#ifdef BUMP
    lit.diffuse *= bump_dim * above_horizon(dot(smooth_normal, l));
#endif
#ifdef SPECULAR
#ifdef BUMP
    vec3 sum = l + surface.to_viewer;
    // Zero where the light is exactly behind the point.
    vec3 h = dot(sum, sum) > 0.0 ? normalize(sum) : vec3(0.0);
#else
    vec3 h = normalize(l + surface.to_viewer);
#endif
#ifdef SELF_SHADOW
    float gloss = pow(max(dot(surface.normal, h), 0.0), shininess);
    gloss *= above_horizon(dot(smooth_normal, l)) * above_horizon(dot(smooth_normal, h));
#else
    float gloss = n_dot_l > 0.0 ? pow(max(dot(surface.normal, h), 0.0), shininess) : 0.0;
#endif
    lit.specular = strength * gloss * light_specular_@ * material_specular;
#else
    lit.specular = vec3(0.0);
#endif
#endif
    return lit;
}
