"""Measures of one made hand, from their published definitions, in plain Python: what studio/compare must give.

The hand goes along an ellipse while it falls, with a tremor, and presses with a force that swells twice. Positions are
in metres at 1000 Hz; hands are measured at 100 Hz, from means of ten ticks.
"""
import cmath
import math

TICK, GROUP, TICKS = 1e-3, 10, 3000
RATE = 1 / (TICK * GROUP)


def place(tick):
    u = tick / TICKS
    s = u**3 * (10 - 15 * u + 6 * u * u)
    shake = 2e-4 * math.sin(2 * math.pi * 7 * tick * TICK)
    return (0.03 * math.cos(2 * s), 0.05 * math.sin(2 * s) + shake, 0.02 * s)


def force(tick):
    return max(0.0, 3 * math.sin(2 * math.pi * tick / TICKS) ** 2 - 0.5)


def distance(a, b):
    return math.sqrt(sum((p - q) ** 2 for p, q in zip(a, b)))


def mean_points(points):
    return [tuple(sum(p[k] for p in points[i:i + GROUP]) / GROUP for k in range(3))
            for i in range(0, len(points) - GROUP + 1, GROUP)]


def low_passed(points, rate):
    """Gaussian whose squared transform is 1/2 at 10 Hz; the path is turned about its ends."""
    width = math.sqrt(math.log(2)) / (2 * math.pi * 10) * rate
    reach, last = math.ceil(4 * width), len(points) - 1

    def at(i):
        if i < 0:
            return tuple(2 * a - b for a, b in zip(points[0], points[min(-i, last)]))
        if i > last:
            return tuple(2 * a - b for a, b in zip(points[last], points[max(2 * last - i, 0)]))
        return points[i]

    weights = [math.exp(-0.5 * (d / width) ** 2) for d in range(-reach, reach + 1)]
    total = sum(weights)
    return [tuple(sum(w * at(i + d)[k] for d, w in zip(range(-reach, reach + 1), weights)) / total for k in range(3))
            for i in range(len(points))]


def movement(speed):
    """The one movement of this hand: from the first to the last value above a twentieth of the largest."""
    fast = [i for i, v in enumerate(speed) if v > 0.05 * max(speed)]
    return speed[fast[0]:fast[-1] + 1]


def spectral_arc_length(speed):
    """Balasubramanian et al. 2015, equation for SPARC: cut-off 10 Hz, amplitude 0.05, padding 4."""
    size = 2 ** (math.ceil(math.log2(len(speed))) + 4)
    count = int(10 / (RATE / size)) + 1
    amplitude = [abs(sum(v * cmath.exp(-2j * math.pi * k * n / size) for n, v in enumerate(speed)))
                 for k in range(count)]
    amplitude = [a / max(amplitude) for a in amplitude]
    last = max(k for k, a in enumerate(amplitude) if a >= 0.05)
    return -sum(math.hypot(1 / last, amplitude[k] - amplitude[k - 1]) for k in range(1, last + 1))


def log_dimensionless_jerk(speed):
    """Balasubramanian et al. 2015: second differences of the speed; the duration is that of all samples."""
    jerk = [(speed[i] - 2 * speed[i - 1] + speed[i - 2]) * RATE**2 for i in range(2, len(speed))]
    return -math.log((len(speed) / RATE) ** 3 / max(speed) ** 2 * sum(j * j for j in jerk) / RATE)


def main():
    points, forces = [place(t) for t in range(TICKS)], [force(t) for t in range(TICKS)]
    way = low_passed(points, 1 / TICK)
    steps = [distance(way[i], way[i - 1]) for i in range(1, TICKS)]
    hand = low_passed(mean_points(points), RATE)
    speed = movement([distance(hand[i], hand[i - 1]) * RATE for i in range(1, len(hand))])
    under = [(f, s) for f, s in zip(forces[1:], steps) if f > 0]
    print("path_length_mm %.10f" % (1e3 * sum(steps)))
    print("spectral_arc_length %.10f" % spectral_arc_length(speed))
    print("log_dimensionless_jerk %.10f" % log_dimensionless_jerk(speed))
    print("peak_force_n %.10f" % max(forces))
    print("mean_force_n %.10f" % (sum(f * s for f, s in under) / sum(s for _, s in under)))
    print("time_above_force_limit_s %.10f" % (TICK * sum(f > 1.5 for f in forces)))
    print("impulse_above_force_limit_n_s %.10f" % (TICK * sum(f - 1.5 for f in forces if f > 1.5)))


main()
