#!/usr/bin/env python3
"""Sends a TUM RGB-D folder, or any with rgb.txt and depth.txt, to surefield run --live. Standard library alone.

  send_tum.py FOLDER - [fx fy cx cy] | surefield run --live - --out out/run
  send_tum.py FOLDER unix:/tmp/camera [fx fy cx cy]        # after surefield run --live unix:/tmp/camera --out out/run
"""
import os
import socket
import struct
import sys


def rows(folder, name):
    lines = [line.split() for line in open(os.path.join(folder, name)) if line.strip() and line[0] != "#"]
    return [(float(line[0]), line[1]) for line in lines]


def open_output(place):
    if place == "-":
        return sys.stdout.buffer
    kind, address = place.split(":", 1)
    out = socket.socket(socket.AF_UNIX if kind == "unix" else socket.AF_INET)
    out.connect(address if kind == "unix" else (address.split(":")[0], int(address.split(":")[1])))
    return out.makefile("wb")


def message(tag, body):
    return tag + struct.pack("<I", len(body)) + body


def main():
    folder, place = sys.argv[1:3]
    camera = [float(text) for text in sys.argv[3:7]] or [525, 525, 319.5, 239.5]  # pixels: fx fy cx cy
    colours, depths = rows(folder, "rgb.txt"), rows(folder, "depth.txt")
    first = open(os.path.join(folder, colours[0][1]), "rb").read()
    width, height = struct.unpack(">II", first[16:24])  # of a PNG
    every_frame = 1  # a flag: the receiver takes its time, and drops nothing
    out = open_output(place)
    out.write(message(b"SFLH", struct.pack("<4I5d2I14d64s", 1, every_frame, width, height, *camera, 1 / 5000, 0, 0,
                                           *[0] * 14, os.path.basename(os.path.abspath(folder)).encode())))
    for stamp, name in colours:
        depth_stamp, depth_name = min(depths, key=lambda row: abs(row[0] - stamp))
        if abs(depth_stamp - stamp) > 0.02:
            continue
        colour = open(os.path.join(folder, name), "rb").read()
        depth = open(os.path.join(folder, depth_name), "rb").read()
        png, png16 = 3, 1
        out.write(message(b"SFLF", struct.pack("<2I2d2I", png, png16, stamp, depth_stamp, len(colour), len(depth))
                          + colour + depth))
    out.write(message(b"SFLE", b""))
    out.flush()


try:
    main()
except BrokenPipeError:
    sys.stderr.close()  # nobody listens any more, and nobody is to be told so again at exit
    sys.exit(1)
