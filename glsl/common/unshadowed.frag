float shade_@()
{
    return 1.0;
}
