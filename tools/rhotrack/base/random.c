/* SPDX-License-Identifier: MIT */
#include "base/random.h"

#include <math.h>

static uint64_t rotate_left(uint64_t v, int bits)
{
    return (v << bits) | (v >> (64 - bits));
}

/* splitmix64 generator: advances the counter and returns its scrambled value. */
static uint64_t splitmix64(uint64_t *counter)
{
    uint64_t v = (*counter += 0x9e3779b97f4a7c15u);
    v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9u;
    v = (v ^ (v >> 27)) * 0x94d049bb133111ebu;
    return v ^ (v >> 31);
}

struct random random_start(uint64_t seed, uint64_t stream, uint64_t run)
{
    struct random random;
    uint64_t counter = seed;
    counter = splitmix64(&counter) ^ stream;
    counter = splitmix64(&counter) ^ run;
    for (int i = 0; i < 4; i++) {
        random.state[i] = splitmix64(&counter);
    }
    return random;
}

uint64_t random_bits(struct random *random)
{
    uint64_t *s = random->state;
    uint64_t result = rotate_left(s[1] * 5, 7) * 9;
    uint64_t shifted = s[1] << 17;
    s[2] ^= s[0];
    s[3] ^= s[1];
    s[1] ^= s[2];
    s[0] ^= s[3];
    s[2] ^= shifted;
    s[3] = rotate_left(s[3], 45);
    return result;
}

double random_uniform(struct random *random)
{
    return (double)(random_bits(random) >> 11) * 0x1p-53;
}

double random_between(struct random *random, double lo, double hi)
{
    return lo + (hi - lo) * random_uniform(random);
}

uint64_t random_below(struct random *random, uint64_t n)
{
    /* reject bits beyond the largest multiple of n, which would favour small results */
    uint64_t limit = UINT64_MAX - UINT64_MAX % n;
    uint64_t bits = random_bits(random);
    while (bits >= limit) {
        bits = random_bits(random);
    }
    return bits % n;
}

/*
 * Normal deviate by Leva's ratio of uniforms ("A fast normal random number generator", ACM TOMS 18,
 * 1992): two quadratic bounds save 99 % of the logarithms.
 */
double random_normal(struct random *random)
{
    for (;;) {
        double u = 1.0 - random_uniform(random);
        double v = 1.7156 * (random_uniform(random) - 0.5);
        double x = u - 0.449871;
        double y = fabs(v) + 0.386595;
        double q = x * x + y * (0.19600 * y - 0.25472 * x);
        if (q < 0.27597 || (q <= 0.27846 && v * v <= -4.0 * log(u) * u * u)) {
            return v / u;
        }
    }
}

/*
 * Poisson deviate by Knuth's product of uniforms; large means in parts, as exp(-mean) underflows.
 */
uint64_t random_poisson(struct random *random, double mean)
{
    uint64_t count = 0;
    while (mean > 0.0) {
        double part = mean > 500.0 ? 500.0 : mean;
        double limit = exp(-part);
        double product = 1.0 - random_uniform(random);
        while (product > limit) {
            count++;
            product *= 1.0 - random_uniform(random);
        }
        mean -= part;
    }
    return count;
}
