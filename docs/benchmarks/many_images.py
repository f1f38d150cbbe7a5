#!/usr/bin/env python3
"""Writes a glTF file with many JPEG textures of 1024x1024 pixels into a folder. Needs oiiotool.

    many_images.py FOLDER [--count 320]
"""
import argparse
import base64
import json
import pathlib
import shutil
import struct
import subprocess


def parse():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=320)
    return parser.parse_args()


def write_images(folder, count):
    """Copies of one noisy picture: what takes the time is the decoding."""
    first = folder / "0.jpg"
    subprocess.run(["oiiotool", "--pattern", "noise:type=gaussian:mean=0.5:stddev=0.1",
                    "1024x1024", "3", "--blur", "5x5", "-o", str(first)], check=True)
    for i in range(1, count):
        shutil.copy(first, folder / f"{i}.jpg")


def write_gltf(folder, count):
    """A triangle for each texture."""
    data = struct.pack("<15f", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1)
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    each = range(count)
    gltf = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": len(data), "uri": uri}],
        "bufferViews": [{"buffer": 0, "byteLength": 36},
                        {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
        "images": [{"uri": f"{i}.jpg"} for i in each],
        "textures": [{"source": i} for i in each],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": i}}} for i in each],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1},
                                    "material": i}]} for i in each],
        "nodes": [{"mesh": i, "translation": [i, 0, 0]} for i in each],
        "scenes": [{"nodes": list(each)}],
        "scene": 0,
    }
    (folder / "many.gltf").write_text(json.dumps(gltf), encoding="utf-8")


def main():
    options = parse()
    options.folder.mkdir(parents=True, exist_ok=True)
    write_images(options.folder, options.count)
    write_gltf(options.folder, options.count)


main()
