// Percentage-closer filtering [Reeves 1987; LEC, "Hardware Shadow Map Filtering"]: the mean of
// KERNEL_@ x KERNEL_@ comparisons, one texel apart, each weighted alike.

// The first tap's place along each axis, in texels from the kernel's centre.
const float FIRST_TAP_@ = 0.5 * float(1 - KERNEL_@);

// One comparison, which the chunk behind this one defines. `tap` counts whole texels from the first tap.
float compare_tap_@(vec2 tap);

float percentage_closer_@()
{
    float lit = 0.0;
    for (int y = 0; y < KERNEL_@; ++y)
        for (int x = 0; x < KERNEL_@; ++x)
            lit += compare_tap_@(vec2(x, y));
    return lit / float(KERNEL_@ * KERNEL_@);
}
