# SPDX-License-Identifier: MIT
"""Prints the variance of a picture, from two with different noise.

usage: noise.py A.pfm B.pfm

The variance is the mean over all channels of half the squared difference,
divided by the square of the channel's mean plus .01. It is relative, since
otherwise lamps would dominate.
"""
import array
import sys


def read(path):
    with open(path, "rb") as file:
        for _ in range(3):
            file.readline()
        return array.array("f", file.read())


def main():
    a, b = (read(path) for path in sys.argv[1:])
    parts = ((x - y) ** 2 / 2 / (((x + y) / 2) ** 2 + 0.01)
             for x, y in zip(a, b))
    print(sum(parts) / len(a))


main()
