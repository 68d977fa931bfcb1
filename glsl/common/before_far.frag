// The camera's far plane, where the projection has none: nothing is drawn whose window depth exceeds far_depth.
#undef main
uniform float far_depth;

void main()
{
    if (gl_FragCoord.z > far_depth)
        discard;
    main_before_far();
}
