// The camera's far plane, where nothing is clipped by it: 1 / gl_FragCoord.w is the distance along the view.
#undef main
uniform float view_far;

void main()
{
    main_before_far();
    // Last: derivatives are undefined where a neighbour was discarded before [GLSL 4.60, 6.4].
    if (1.0 / gl_FragCoord.w > view_far)
        discard;
}
