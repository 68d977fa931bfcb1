void main()
{
    set_position();
}
