// Wrong on purpose: GL_LINEAR averages the depths of light @'s map, and their mean is compared once. Between a caster and what
// lies behind it the mean is a depth at which nothing is.
uniform sampler2D shadow_map_@;

float shade_@()
{
    vec3 at = light_coord_@.xyz / light_coord_@.w;
    return at.z <= texture(shadow_map_@, at.xy).r ? 1.0 : 0.0;
}
