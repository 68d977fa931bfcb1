#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 tangent;
layout(location = 3) in vec3 bitangent;
layout(location = 4) in vec2 texcoord;
uniform mat4 clip_from_model;
uniform mat4 world_from_model;
uniform mat4 texture_from_model;
uniform vec3 light;
uniform vec3 eye;
out vec2 st;
out vec3 to_light;
out vec3 half_way;
out vec4 map_coord;
void main()
{
    gl_Position = clip_from_model * vec4(position, 1.0);
    map_coord = texture_from_model * vec4(position, 1.0);
    vec3 world = vec3(world_from_model * vec4(position, 1.0));
    // Rotations and even scales only.
    mat3 basis = mat3(world_from_model) * mat3(tangent, bitangent, normal);
    to_light = (light - world) * basis;
    half_way = normalize(to_light) + normalize((eye - world) * basis);
    st = texcoord;
}
