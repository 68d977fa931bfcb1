// Where light @ cannot light: behind its plane, all over.
bool in_reach_@()
{
    return false;
}
