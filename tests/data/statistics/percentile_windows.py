"""Weights of the window of a smoothed percentile, summed up to a rank, with 50 digits.

    python tests/data/statistics/percentile_windows.py > tests/data/statistics/percentile_windows.csv

Needs mpmath. The weight of rank i is the mass of Beta(m p, m (1 - p)) between (i - 1)/n and i/n, with
m = (n + 1)/4, cut off at 2.5 standard deviations of that law and set to a sum of 1 (docs/statistics.md).
Columns: patterns n, percent, a rank, and the sum of the weights of all ranks up to it.
"""

import mpmath as mp

mp.mp.dps = 50


def below(a, b, x):
    """Regularised incomplete beta function by quadrature over pieces of its density."""
    mean = a / (a + b)
    spread = mp.sqrt(mean * (1 - mean) / (a + b + 1))
    log_front = mp.loggamma(a + b) - mp.loggamma(a) - mp.loggamma(b)

    def density(t):
        return mp.exp(log_front + (a - 1) * mp.log(t) + (b - 1) * mp.log(1 - t))

    low = max(mp.mpf(0), mean - 20 * spread)
    ends = [t for t in mp.linspace(low, x, 24)]
    return mp.quad(density, ends)


def main():
    print("patterns,percent,rank,weights_up_to_it")
    for n in (1_000, 100_000, 1_000_000):
        for percent in (50, 95, 99):
            p = mp.mpf(percent) / 100
            m = mp.mpf(n + 1) / 4
            a, b = m * p, m * (1 - p)
            reach = mp.mpf("2.5") * mp.sqrt(p * (1 - p) / (m + 1))
            first = max(0, int(mp.floor((p - reach) * n)))
            last = min(n, int(mp.ceil((p + reach) * n)))
            start, end = below(a, b, mp.mpf(first) / n), below(a, b, mp.mpf(last) / n)
            for share in (0.2, 0.4, 0.5, 0.6, 0.8):
                rank = first + int(round(share * (last - first)))
                part = (below(a, b, mp.mpf(rank) / n) - start) / (end - start)
                print(f"{n},{percent},{rank},{mp.nstr(part, 17)}")


main()
