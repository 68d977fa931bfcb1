void main()
{
    set_position();
#ifdef ALPHA_TEST
    set_decal();
#endif
}
