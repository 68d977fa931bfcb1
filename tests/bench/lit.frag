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
    float lambert = max(dot(normalize(surface_normal), normalize(light - world)), 0.0);
    vec2 off = map_coord.xy - 0.5 * map_coord.w;
    float reach = map_coord.w > 0.0 && dot(off, off) <= 0.25 * map_coord.w * map_coord.w ? 1.0 : 0.0;
    color = vec4(vec3(material * (0.2 + reach * textureProj(map, map_coord) * lambert)), 1.0);
}
