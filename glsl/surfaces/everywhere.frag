// A point or directional light: nothing bounds where light @ can light.
bool in_reach_@()
{
    return true;
}
