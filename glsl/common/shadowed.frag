float shade_@()
{
    return 0.0;
}
