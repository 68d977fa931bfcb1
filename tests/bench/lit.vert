#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 clip_from_world;
uniform mat4 texture_from_world;
uniform vec3 offset;
out vec3 world;
out vec3 surface_normal;
out vec4 map_coord;
void main()
{
    vec4 place = vec4(position + offset, 1.0);
    gl_Position = clip_from_world * place;
    map_coord = texture_from_world * place;
    world = place.xyz;
    surface_normal = normal;
}
