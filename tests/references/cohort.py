#!/usr/bin/env python3
"""Reference numbers of tests/studio/cohort/statistics_test.cpp, from their definitions and nothing of the program:
SplitMix64, bootstrap intervals of a mean, a cumulative sum of failures. Needs Python alone."""
import math

MASK = (1 << 64) - 1


def splitmix(seed):
    """The generator of Steele, Lea and Flood 2014 as it is published: with a state that goes on."""
    state = seed
    while True:
        state = (state + 0x9E3779B97F4A7C15) & MASK
        z = state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
        yield z ^ (z >> 31)


def bootstrap(values, seed, resamples, confidence):
    numbers = splitmix(seed)
    means = sorted(
        sum(values[(next(numbers) >> 32) * len(values) >> 32] for _ in values) / len(values) for _ in range(resamples))
    skipped = math.floor((1 - confidence) / 2 * resamples)
    return means[skipped], means[-1 - skipped]


def cusum(passed, p0, p1, a, b):
    p, q = math.log(p1 / p0), math.log((1 - p0) / (1 - p1))
    s = q / (p + q)
    low, high = -math.log((1 - a) / b) / (p + q), math.log((1 - b) / a) / (p + q)
    total, steps = 0.0, []
    for is_pass in passed:
        total += -s if is_pass else 1 - s
        # Whole numbers of attempts often end on a limit: rounding must not decide.
        word = "learned" if total <= low + 1e-9 else "failing" if total >= high - 1e-9 else ""
        steps.append((total, word))
        if word:
            total = 0.0
    return low, high, s, steps


if __name__ == "__main__":
    numbers = splitmix(1234567)
    print("splitmix 1234567:", [next(numbers) for _ in range(3)])
    values = [3.1, 4.7, 2.2, 5.9, 4.4, 3.8, 6.3]
    print("bootstrap seed 1:", ["%.15g" % v for v in bootstrap(values, 1, 2000, 0.95)])
    print("bootstrap seed 7:", ["%.15g" % v for v in bootstrap(values, 7, 500, 0.9)])
    mean = sum(values) / len(values)
    print("mean %.15g deviation %.15g" %
          (mean, math.sqrt(sum((v - mean)**2 for v in values) / (len(values) - 1))))
    low, high, s, steps = cusum([c == "1" for c in "0001011111111111111111111000"], 0.1, 0.3, 0.1, 0.1)
    print("limits %.15g %.15g pass %.15g" % (low, high, s))
    for i, (total, word) in enumerate(steps, 1):
        print(i, "%.15g" % total, word)
