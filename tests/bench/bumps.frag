#version 330 core
in vec2 st;
in vec3 to_light;
in vec3 half_way;
in vec4 map_coord;
uniform sampler2DShadow map;
uniform sampler2D normal_map;
uniform samplerCube unit_vectors;
uniform sampler2D decal;
uniform vec3 ambient;
uniform vec3 diffuse;
uniform vec3 specular;
out vec4 color;
void main()
{
#ifdef DECAL
    color = vec4(texture(decal, st).rgb, 1.0);
#else
    vec2 off = map_coord.xy - 0.5 * map_coord.w;
    bool reached = map_coord.w > 0.0 && dot(off, off) <= 0.25 * map_coord.w * map_coord.w;
    float shade = reached ? textureProj(map, map_coord) : 0.0;
#ifdef FLAT
    float lambert = max(normalize(to_light).z, 0.0);
    color = vec4(ambient + shade * lambert * diffuse, 1.0);
#else
    vec4 texel = texture(normal_map, st);
    vec3 l = 2.0 * texture(unit_vectors, to_light).rgb - 1.0;
    float above = min(1.0, 8.0 * max(l.z, 0.0));
#ifndef HIGHLIGHTS
    vec3 lit = ambient + shade * texel.a * above * max(dot(texel.rgb, l), 0.0) * diffuse;
#ifdef LIGHT
    color = vec4(lit, 1.0);
#endif
#endif
#ifndef LIGHT
    vec3 h = 2.0 * texture(unit_vectors, half_way).rgb - 1.0;
    float gleam = max(dot(texel.rgb, h), 0.0);
    gleam *= gleam;
    gleam *= gleam;
    gleam *= gleam;
    vec3 highlight = shade * above * min(1.0, 8.0 * max(h.z, 0.0)) * gleam * specular;
#ifdef HIGHLIGHTS
    color = vec4(highlight, 1.0);
#else
    color = vec4(lit * texture(decal, st).rgb + highlight, 1.0);
#endif
#endif
#endif
#endif
}
