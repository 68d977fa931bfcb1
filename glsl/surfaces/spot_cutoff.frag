flat in float spot_factor_@;

float side_@()
{
    return spot_factor_@;
}
