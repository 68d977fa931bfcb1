// The decal's texture coordinates: the mesh's own, or object-linear planes and a texture matrix that scales
// [GL 4.6 compatibility, 12.1.3].
#ifdef OBJECT_LINEAR
uniform vec4 object_planes[2];
uniform float texture_scale;
#else
layout(location = 2) in vec2 texcoord;
#endif

out vec2 st;

void set_decal()
{
#ifdef OBJECT_LINEAR
    vec4 model = vec4(position, 1.0);
    st = texture_scale * vec2(dot(object_planes[0], model), dot(object_planes[1], model));
#else
    st = texcoord;
#endif
}
