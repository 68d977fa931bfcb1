uniform vec3 guide_color;

out vec4 fragment;

void main()
{
    fragment = vec4(guide_color, 1.0);
}
