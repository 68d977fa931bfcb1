// The camera's near and far planes, where nothing is clipped by them: 1 / gl_FragCoord.w is the distance along the view.
#undef main
uniform vec2 view_range;

void main()
{
    float distance = 1.0 / gl_FragCoord.w;
    if (distance < view_range.x || distance > view_range.y)
        discard;
    main_between_planes();
}
