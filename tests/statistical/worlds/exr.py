"""Reads the uncompressed float pictures that ppm-render writes with --exr-compression none."""

import struct


def read_rgb(path):
    """Width, height, and three lists of floats by rows from the top: R, G, B."""
    with open(path, "rb") as file:
        data = file.read()
    attributes, at = read_header(data)
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    names = channel_names(attributes["channels"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    if attributes["compression"] != b"\0":
        raise ValueError(f"{path}: compressed")
    planes = {name: [] for name in "RGB"}
    for row in range(height):
        (offset,) = struct.unpack_from("<Q", data, at + 8 * row)
        for i, name in enumerate(names):
            if name in planes:
                planes[name] += struct.unpack_from(f"<{width}f", data, offset + 8 + 4 * i * width)
    return width, height, [planes[name] for name in "RGB"]


def read_header(data):
    """Attributes by name, and where the offsets of the rows begin."""
    at, attributes = 8, {}
    while data[at] != 0:
        name_end = data.index(b"\0", at)
        kind_end = data.index(b"\0", name_end + 1)
        (size,) = struct.unpack_from("<i", data, kind_end + 1)
        value = data[kind_end + 5:kind_end + 5 + size]
        attributes[data[at:name_end].decode()] = value
        at = kind_end + 5 + size
    return attributes, at + 1


def channel_names(channels):
    names, at = [], 0
    while channels[at] != 0:
        end = channels.index(b"\0", at)
        if struct.unpack_from("<i", channels, end + 1)[0] != 2:
            raise ValueError("a channel that is not float")
        names.append(channels[at:end].decode())
        at = end + 17
    return names
