#version 330 core
in vec4 map_coord;
uniform sampler2DShadow map;
// The way of the view ray through a pixel, at distance 1 along the view axis: scale, then offset.
uniform vec2 ray_from_pixel;
uniform float optical_depth;
out vec4 color;
void main()
{
    vec2 off = map_coord.xy - 0.5 * map_coord.w;
    if (map_coord.w <= 0.0 || dot(off, off) > 0.25 * map_coord.w * map_coord.w)
        discard;
    vec2 ray = ray_from_pixel.x * gl_FragCoord.xy + ray_from_pixel.y;
    float opacity = 1.0 - exp(-optical_depth * sqrt(1.0 + dot(ray, ray)));
    color = opacity * vec4(textureProj(map, map_coord));
}
