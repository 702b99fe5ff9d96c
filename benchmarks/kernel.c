/* The exponents of many pairs, with nothing around the arithmetic: what a generated solver is measured against.

root.h, which bench_engine.py prints from the workbook's own equation, holds `root`: the starting value and four
Newton steps on (11) in u = 1/(alpha + 1), and the exponent that belongs to u. Nothing is decided, bracketed or
checked. The two functions below are without branches and tables, so that a compiler makes vectors of the loop. */

#include <math.h>
#include <stdint.h>
#include <string.h>

/* Added to a number, it leaves a whole one in the last bits. */
#define WHOLE 0x1.8p52

static inline double ln(double x)
{
    /* x = 2^n m with m in [sqrt(1/2), sqrt(2)); ln m = 2 artanh s by its series, s^2 < .0295. */
    uint64_t bits, exponent;
    memcpy(&bits, &x, sizeof bits);
    exponent = (bits - 0x3fe6a09e667f3bcd + 0x3ff0000000000000) >> 52; /* n + 1023 */
    bits -= (exponent << 52) - 0x3ff0000000000000;
    exponent += 0x4338000000000000; /* of 1.5 * 2^52, whose last bits now count n + 1023 */
    double m, n;
    memcpy(&m, &bits, sizeof m);
    memcpy(&n, &exponent, sizeof n);
    double s = (m - 1) / (m + 1), z = s * s, sum = 0;
    for (int k = 21; k > 0; k -= 2)
        sum = sum * z + 1.0 / k;
    return (n - (WHOLE + 1023)) * 0.6931471805599453 + 2 * s * sum;
}

static inline double e_to(double x)
{
    /* x = n ln 2 + r with |r| <= ln(2)/2; e^r by its series. */
    double shifted = x * 1.4426950408889634 + WHOLE, n = shifted - WHOLE;
    double r = (x - n * 0.693147180369123816490) - n * 1.90821492927058770002e-10, sum = 1;
    for (int k = 13; k > 0; k--)
        sum = sum * r * (1.0 / k) + 1;
    uint64_t bits;
    memcpy(&bits, &shifted, sizeof bits);
    bits = (bits << 52) + 0x3ff0000000000000;
    double scale;
    memcpy(&scale, &bits, sizeof scale);
    return sum * scale;
}

#include "root.h"

/* Two tests a row, as NumPy holds them. */
void roots(int64_t count, double beta, const double *restrict v, const double *restrict e,
           const double *restrict x_p, double *restrict alpha)
{
    for (int64_t i = 0; i < count; i++)
        alpha[i] = root(beta, v[2 * i], v[2 * i + 1], e[2 * i], e[2 * i + 1], x_p[2 * i], x_p[2 * i + 1]);
}
