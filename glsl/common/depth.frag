void main()
{
#ifdef ALPHA_TEST
    alpha_test();
#endif
}
