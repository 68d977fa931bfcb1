#version 330 core
in vec3 world;
in vec3 surface_normal;
in vec4 map_coord;
#ifdef CUBE
uniform samplerCubeShadow map;
uniform vec2 face_depth;
#elif !defined(SHADE)
uniform sampler2DShadow map;
#endif
uniform vec3 light;
uniform float material;
out vec4 color;
#define light_coord_0 map_coord
//SHADE//
void main()
{
    vec3 to_light = light - world;
    float reach = 1.0;
#ifdef DERIVE
    derive_shade_0();
#endif
#ifdef CUBE
    vec3 size = abs(to_light);
    float depth = max(size.x, max(size.y, size.z));
    float shade = texture(map, vec4(-to_light, face_depth.x - face_depth.y / depth));
#else
#ifdef PARALLEL
    to_light = light;
#else
    vec2 off = map_coord.xy - 0.5 * map_coord.w;
    reach = map_coord.w > 0.0 && dot(off, off) <= 0.25 * map_coord.w * map_coord.w ? 1.0 : 0.0;
#endif
#ifdef SHADE
    float shade = shade_0();
#else
    float shade = textureProj(map, map_coord);
#endif
#endif
    float lambert = max(dot(normalize(surface_normal), normalize(to_light)), 0.0);
#ifdef LENS
    color = vec4(vec3(material * (reach * shade * lambert / 64.0)), 0.0);
#else
    color = vec4(vec3(material * (0.2 + reach * shade * lambert)), 1.0);
#endif
}
