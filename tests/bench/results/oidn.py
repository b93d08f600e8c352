# SPDX-License-Identifier: MIT
"""Filters the picture of tests/bench/surfaces with Open Image Denoise.

usage: oidn.py STEM

Reads STEM_raw.pfm, STEM_albedo.pfm and STEM_normal.pfm and writes
STEM_oidn.pfm. Needs pyoidn and numpy.
"""
import sys

import numpy
import pyoidn


def read(path):
    with open(path, "rb") as f:
        f.readline()
        width, height = (int(word) for word in f.readline().split())
        kind = "<f4" if float(f.readline()) < 0 else ">f4"
        data = numpy.frombuffer(f.read(), kind).astype(numpy.float32)
    return data.reshape(height, width, 3)


def write(path, rgb):
    with open(path, "wb") as f:
        f.write(b"PF\n%d %d\n-1.0\n" % (rgb.shape[1], rgb.shape[0]))
        f.write(rgb.astype("<f4").tobytes())


stem = sys.argv[1]
write(
    stem + "_oidn.pfm",
    pyoidn.denoise(
        read(stem + "_raw.pfm"),
        albedo=read(stem + "_albedo.pfm"),
        normal=read(stem + "_normal.pfm"),
        hdr=True,
    ),
)
