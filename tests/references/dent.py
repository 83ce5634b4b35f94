#!/usr/bin/env python3
"""Stiffness of the dent under a ball that meets Hertz's force where the surface blurs every point load.

Units: E / (1 - nu^2) = 1, and the length l in which a load moves its own place, u = F / (pi l), is 1. The blur is a
Gaussian. For each contact radius a, the script finds the pressure per depth k of a foundation in series with the
blurred half space, so that a ball meets 4/3 sqrt(R) d^1.5 (Johnson, "Contact mechanics", 1985, ch. 4), and prints
k a / 0.6 beside the closed form that core/contact/contact_law.h uses.

Needs python3-numpy and python3-scipy.
"""
import numpy as np
from scipy.optimize import brentq
from scipy.special import ive

SIGMA = np.sqrt(np.pi / 2)  # of the blur, so that a load moves its own place as in l = 1
RINGS, ANGLES = 120, 64


def blurred(r):
    """Displacement at distance r of a blurred unit load, times pi."""
    z = r * r / (4 * SIGMA * SIGMA)
    return np.sqrt(np.pi / 2) / SIGMA * ive(0, z)


def press(radius, depth, k):
    """Force and radius of the touched area; rings that pull are left out."""
    edges = np.linspace(0, np.sqrt(2 * radius * depth) * 1.001, RINGS + 1)
    middle, area = (edges[1:] + edges[:-1]) / 2, np.pi * (edges[1:] ** 2 - edges[:-1] ** 2)
    angle = (np.arange(ANGLES) + 0.5) * np.pi / ANGLES
    apart = np.sqrt(middle[:, None, None] ** 2 + middle[None, :, None] ** 2
                    - 2 * middle[:, None, None] * middle[None, :, None] * np.cos(angle))
    influence = blurred(apart).mean(2) * area[None, :] / np.pi
    gap, touches = depth - middle**2 / (2 * radius), np.ones(RINGS, bool)
    for _ in range(60):
        pressure = np.zeros(RINGS)
        system = influence[np.ix_(touches, touches)] + np.eye(touches.sum()) / k
        pressure[touches] = np.linalg.solve(system, gap[touches])
        now = np.where(touches, pressure > 0, gap - influence @ pressure > 0)
        if (now == touches).all():
            break
        touches = now
    return (pressure * area).sum(), np.sqrt(area[pressure > 0].sum() / np.pi)


def closed_form(x):
    return 1 + x * (0.5 + 0.85 * x * x / (x + 1.5))


if __name__ == "__main__":
    for overlap in (0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1, 1.3, 1.6, 2, 2.5, 3, 4, 5, 6):
        radius = 1e3
        depth = overlap**2 / (2 * radius)
        hertz = 4 / 3 * np.sqrt(radius) * depth**1.5
        k = np.exp(brentq(lambda log_k: press(radius, depth, np.exp(log_k))[0] - hertz, np.log(0.05), np.log(1e4)))
        a = press(radius, depth, k)[1]
        print(f"a / l {a:6.3f}   k a / 0.6 {k * a / 0.6:8.4f}   closed form {closed_form(a):8.4f}")
