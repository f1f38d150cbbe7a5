#!/usr/bin/env python3
"""Renders every model in a folder and lays the pictures out on sheets, to be looked at.

    docs/contact_sheet/contact_sheet.py FOLDER [FOLDER ...] [--out out/contact_sheet]

Each sheet holds some rows of pictures with their names; files.tsv beside them says how each render
ended and what the program said. A file that could not be rendered is a dark red tile. Needs
oiiotool (Debian: openimageio-tools).
"""
import argparse
import concurrent.futures
import pathlib
import shutil
import subprocess
import sys

ENDINGS = {".gltf", ".glb", ".obj"}


def find_models(folders):
    """All models below the folders, in the order of their names."""
    found = []
    for folder in folders:
        if folder.is_file():
            found.append((folder.parent, folder))
            continue
        found += [(folder, p) for p in sorted(folder.rglob("*")) if p.suffix.lower() in ENDINGS]
    return found


def render(options, root, model, index):
    """One picture; returns (model, picture or None, exit status, messages)."""
    picture = options.out / "pictures" / f"{index:04d}.png"
    command = [options.program, str(model), "-o", str(picture), "-s", options.size,
               "-n", str(options.passes), "--threads", "1"] + options.extra
    try:
        run = subprocess.run(command, capture_output=True, text=True, errors="replace",
                             timeout=options.timeout, check=False)
        status, said = run.returncode, run.stderr
    except subprocess.TimeoutExpired:
        status, said = "time out", ""
    name = str(model.relative_to(root))
    return name, picture if picture.exists() else None, status, said


def find_font():
    """A font file for the labels, or None."""
    if not shutil.which("fc-match"):
        return None
    match = subprocess.run(["fc-match", "-f", "%{file}", "sans"], capture_output=True, text=True,
                           check=False)
    return match.stdout or None


def label(options, index, name, picture):
    """A tile: the picture with its name below, or a dark red one."""
    width, height = (int(side) for side in options.size.split("x"))
    tile = options.out / "tiles" / f"{index:04d}.png"
    source = [str(picture)] if picture else ["--pattern", "constant:color=0.25,0,0",
                                             options.size, "3"]
    text = name if len(name) <= 34 else "..." + name[-31:]
    text_option = f"--text:x=4:y={height + 13}:size=11:color=1,1,1:font={options.font}"
    subprocess.run(["oiiotool", *source, "--ch", "R,G,B", "--fullsize",
                    f"{width}x{height + 18}", "--croptofull",
                    *([text_option, text] if options.font else []), "-o", str(tile)],
                   check=True, capture_output=True)
    return tile


def lay_out(options, tiles):
    """Sheets of tiles, as many as are needed."""
    per_sheet = options.columns * options.rows
    for begin in range(0, len(tiles), per_sheet):
        part = tiles[begin:begin + per_sheet]
        rows = -(-len(part) // options.columns)
        sheet = options.out / f"sheet_{begin // per_sheet + 1:02d}.png"
        subprocess.run(["oiiotool", *map(str, part), f"--mosaic:pad=4",
                        f"{options.columns}x{rows}", "-o", str(sheet)],
                       check=True, capture_output=True)
        print(sheet)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("folders", nargs="+", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/contact_sheet"))
    parser.add_argument("--program", default="build/release/bin/ppm-render")
    parser.add_argument("--size", default="240x180")
    parser.add_argument("--passes", type=int, default=8)
    parser.add_argument("--columns", type=int, default=7)
    parser.add_argument("--rows", type=int, default=5)
    parser.add_argument("--jobs", type=int, default=2, help="renders at once, one thread each")
    parser.add_argument("--timeout", type=float, default=300.0, help="seconds a render")
    parser.add_argument("--extra", nargs=argparse.REMAINDER, default=[],
                        help="last: further options of ppm-render")
    return parser.parse_args()


def main():
    options = parse_arguments()
    if not shutil.which("oiiotool"):
        sys.exit("contact_sheet.py: oiiotool is not installed (Debian: openimageio-tools)")
    for part in ("pictures", "tiles"):
        shutil.rmtree(options.out / part, ignore_errors=True)
        (options.out / part).mkdir(parents=True)
    options.font = find_font()
    models = find_models(options.folders)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        results = list(pool.map(lambda item: render(options, *item[1], item[0]),
                                enumerate(models)))
    with open(options.out / "files.tsv", "w", encoding="utf-8") as table:
        for name, _, status, said in results:
            print(name, status, " | ".join(said.strip().splitlines()), sep="\t", file=table)
    tiles = [label(options, i, name, picture) for i, (name, picture, _, _) in enumerate(results)]
    lay_out(options, tiles)
    failed = [name for name, picture, _, _ in results if not picture]
    print(f"{len(results) - len(failed)} rendered, {len(failed)} not")


if __name__ == "__main__":
    main()
