void main()
{
    alpha_test();
}
