#version 330 core
in vec3 world;
in vec3 surface_normal;
in vec4 map_coord;
uniform sampler2DShadow map;
uniform vec3 light;
uniform float material;
out vec4 color;
void main()
{
    vec2 off = map_coord.xy - 0.5 * map_coord.w;
#if defined(AMBIENT)
    color = vec4(vec3(0.2), 1.0);
#elif defined(SLIDE)
    bool inside = map_coord.w > 0.0 && max(abs(off.x), abs(off.y)) <= 0.5 * map_coord.w;
    color = vec4(vec3(inside ? 1.0 : 0.0), 1.0);
#elif defined(OWN)
    color = vec4(vec3(material), 1.0);
#elif defined(AMBIENT_OWN)
    color = vec4(vec3(0.2 * material), 1.0);
#elif defined(SHADE)
    bool inside = map_coord.w > 0.0 && dot(off, off) <= 0.25 * map_coord.w * map_coord.w;
    color = vec4(vec3(0.0), inside ? textureProj(map, map_coord) : 0.0);
#else
    float lambert = max(dot(normalize(surface_normal), normalize(light - world)), 0.0);
    color = vec4(vec3(material * lambert), 1.0);
#endif
}
