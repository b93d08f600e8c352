# SPDX-License-Identifier: MIT
"""The variance of a picture, from two with other noise.

usage: noise.py A.pfm B.pfm

Prints the mean over all channels of half the squared difference, each by the
square of the mean there, with .01 added: relative, so that lamps do not drown
the rest.
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
