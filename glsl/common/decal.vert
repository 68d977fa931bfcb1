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
    st = texture_scale * vec2(dot(object_planes[0], position), dot(object_planes[1], position));
#else
    st = texcoord;
#endif
}
