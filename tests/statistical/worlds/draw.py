"""Draws a world at random: a place, lights of several kinds, things. The same seed draws the same.

Everything is in view of path tracing: lights have a size, so that `path` finds the caustics that
photons bring, and the two can be compared.
"""

import math
import random

import glb

UNITS = (0.01, 1.0, 100.0)  # metres of a world's unit; things are about one unit large
GROUNDS = (5, 50, 500, 5000)  # half side of a ground, in units


class World:
    """A file and its setup, and one line that says what it is."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.file = glb.File()
        self.setup = {"cameras": [], "lights": []}
        self.words = []
        self.unit = self.random.choice(UNITS)
        self.words.append(f"unit {self.unit} m")
        self.draw_place()
        self.draw_things()
        self.draw_lights()

    # ---- helpers ---------------------------------------------------------------------------------

    def scaled(self, values):
        return [self.unit * x for x in values]

    def add(self, name, mesh, material):
        mesh.positions = self.scaled(mesh.positions)
        self.file.add(f"{name} {len(self.file.json['nodes'])}", mesh, material)

    def color(self, low=0.2, high=0.8):
        return [self.random.uniform(low, high) for _ in range(3)]

    # ---- the place -------------------------------------------------------------------------------

    def draw_place(self):
        place = self.random.choice(("ground", "room", "window", "two rooms"))
        self.words.append(place)
        self.is_open = place == "ground"
        self.has_daylight = place in ("ground", "window")
        if place == "ground":
            self.draw_ground(self.random.choice(GROUNDS))
            self.camera((self.random.uniform(-2, 2), self.random.uniform(2, 3.5), 5), (0, 0.4, 0), 40)
            return
        if self.random.random() < 0.6:
            self.draw_ground(self.random.choice(GROUNDS[1:]))
        self.thickness = self.random.choice((0.003, 0.03, 0.2))
        self.words.append(f"walls {self.thickness}")
        self.draw_shell(window=place == "window")
        if place == "two rooms":
            t = self.thickness
            self.add("partition", glb.box((2.2 - t / 2, 0, -3), (2.2 + t / 2, 3, 3)), self.wall())
        self.camera((self.random.uniform(-1, 1), self.random.uniform(1, 2), 2.7), (-0.2, 0.6, 0), 60)

    def wall(self):
        return glb.lambert(self.color(0.5, 0.8))

    def draw_ground(self, half):
        self.words.append(f"ground {half}")
        self.half = half
        level = 0.0 if self.is_open else -0.3
        mesh = glb.quad((-half, level, half), (2 * half, 0, 0), (0, 0, -2 * half))
        self.add("ground", mesh, glb.lambert(self.color()))

    def draw_shell(self, window):
        """A room of 8 by 3 by 6 units, x from -4 to 4, of walls with a thickness."""
        t = self.thickness
        self.add("floor", glb.box((-4 - t, -t, -3 - t), (4 + t, 0, 3 + t)), self.wall())
        self.add("ceiling", glb.box((-4 - t, 3, -3 - t), (4 + t, 3 + t, 3 + t)), self.wall())
        self.add("back", glb.box((-4, 0, -3 - t), (4, 3, -3)), self.wall())
        self.add("front", glb.box((-4, 0, 3), (4, 3, 3 + t)), self.wall())
        self.add("right", glb.box((4, 0, -3 - t), (4 + t, 3, 3 + t)), self.wall())
        if not window:
            self.add("left", glb.box((-4 - t, 0, -3 - t), (-4, 3, 3 + t)), self.wall())
            return
        for low, high in (((0, -3 - t), (1, 3 + t)), ((2.5, -3 - t), (3, 3 + t)),
                          ((1, -3 - t), (2.5, -1.5)), ((1, 1.5), (2.5, 3 + t))):
            self.add("left", glb.box((-4 - t, low[0], low[1]), (-4, high[0], high[1])), self.wall())
        if self.random.random() < 0.5:
            self.words.append("pane")
            self.add("pane", glb.quad((-4 - t / 2, 1, -1.5), (0, 0, 3), (0, 1.5, 0)),
                     glb.glass(thickness=0.0))

    def camera(self, position, target, fov):
        self.setup["cameras"].append({"name": "camera", "position": self.scaled(position),
                                      "target": self.scaled(target), "fov": fov})

    # ---- things ----------------------------------------------------------------------------------

    def draw_things(self):
        kinds = self.random.sample(sorted(THINGS), self.random.randint(2, 4))
        for i, kind in enumerate(kinds):
            x = -1.5 + 3.0 * (i + 0.5) / len(kinds) + self.random.uniform(-0.15, 0.15)
            THINGS[kind](self, x, self.random.uniform(-0.8, 0.8))
            self.words.append(kind)

    def thing_box(self, x, z):
        size = self.random.uniform(0.2, 0.4)
        self.add("box", glb.box((x - size, 0, z - size), (x + size, 2.5 * size, z + size)),
                 glb.lambert(self.color()))

    def thing_facets(self, x, z):
        radius = self.random.uniform(0.3, 0.5)
        self.add("ball", glb.sphere((x, radius, z), radius, self.random.choice((8, 12, 24))),
                 glb.lambert(self.color()))

    def thing_glass_ball(self, x, z):
        radius = self.random.uniform(0.25, 0.4)
        self.add("glass ball", glb.sphere((x, radius + 0.1, z), radius, 64), glb.glass())

    def thing_glass_block(self, x, z):
        self.add("glass block", glb.box((x - 0.3, 0.02, z - 0.3), (x + 0.3, 0.5, z + 0.3)),
                 glb.glass(color=(0.8, 0.9, 0.85)))

    def thing_metal(self, x, z):
        roughness = self.random.choice((0.1, 0.3, 0.44, 0.46, 0.7))
        self.words.append(f"roughness {roughness}")
        self.add("metal", glb.sphere((x, 0.35, z), 0.35, 48),
                 glb.principled((0.9, 0.7, 0.4), roughness, metallic=1.0))

    def thing_ring(self, x, z):
        self.add("ring", glb.tube((x, 0, z), 0.4, 0.3, 64, 0.03),
                 glb.principled((0.9, 0.85, 0.8), 0.15, metallic=1.0))

    def thing_plastic(self, x, z):
        self.add("plastic", glb.sphere((x, 0.35, z), 0.35, 48),
                 glb.principled(self.color(), self.random.choice((0.15, 0.4))))

    def thing_wires(self, x, z):
        for i in range(4):
            left, radius = x - 0.3 + 0.2 * i, self.random.choice((0.004, 0.012, 0.03))
            self.add("wire", glb.box((left - radius, 0, z - radius), (left + radius, 1.2, z + radius)),
                     glb.lambert(self.color(0.6, 0.8)))

    def thing_shelf(self, x, z):
        for i in range(3):
            y = 0.02 + self.random.choice((0.02, 0.1, 0.25)) * i
            self.add("shelf", glb.box((x - 0.35, y, z - 0.25), (x + 0.35 - 0.1 * i, y + 0.005, z + 0.25)),
                     glb.lambert(self.color()))

    # ---- lights ----------------------------------------------------------------------------------

    def draw_lights(self):
        kinds = ["sky", "sun"] if self.has_daylight else []
        kinds = self.random.sample(kinds, self.random.randint(0, len(kinds)))
        if self.has_daylight and not kinds or not self.is_open or self.random.random() < 0.3:
            kinds += self.random.sample(["ball", "panel", "spot", "screen", "glow in glass"],
                                        self.random.randint(1, 2))
        if not self.has_daylight and self.random.random() < 0.5:
            kinds.append("sun")  # outside: it must not be seen
        for kind in kinds:
            LIGHTS[kind](self)
            self.words.append(kind)

    def place_of_light(self):
        return [self.random.uniform(-1.8, 1.8), self.random.uniform(1.8, 2.6),
                self.random.uniform(-1.5, 1.0)]

    def light_sky(self):
        self.setup["environment"] = {"color": self.color(0.3, 1.0)}

    def light_sun(self):
        self.setup["lights"].append({"kind": "sun", "elevation": self.random.uniform(25, 70),
                                     "azimuth": self.random.uniform(200, 340),
                                     "angular_diameter": 8.0, "lux": 6.0})

    def light_ball(self):
        self.setup["lights"].append({"kind": "point", "position": self.scaled(self.place_of_light()),
                                     "radius": 0.12 * self.unit, "visible": False,
                                     "candela": 4.0 * self.unit**2})

    def light_panel(self):
        self.setup["lights"].append({
            "kind": "rectangle", "position": self.scaled(self.place_of_light()),
            "target": self.scaled((0, 0, 0)), "width": 0.6 * self.unit, "height": 0.4 * self.unit,
            "nit": 20.0, "visible": False})

    def light_spot(self):
        self.setup["lights"].append({
            "kind": "spot", "position": self.scaled(self.place_of_light()),
            "target": self.scaled((0, 0.3, 0)), "inner_cone": 20, "outer_cone": 35,
            "radius": 0.1 * self.unit, "candela": 12.0 * self.unit**2, "visible": False})

    def light_screen(self):
        side = 16
        rows = [[self.random.choice((0, 0, 0, 40, 255)) for _ in range(side)] for _ in range(side)]
        mesh = glb.quad((-1.5, 0.4, -2.2), (1.8, 0, 0), (0, 1.2, 0))
        self.add("screen", mesh, glb.emitter(8.0, rows))

    def light_glow_in_glass(self):
        x, y, z = self.place_of_light()
        self.add("glow", glb.sphere((x, y, z), 0.12, 24), glb.emitter(40.0))
        self.add("globe", glb.sphere((x, y, z), 0.3, 48), glb.glass())


THINGS = {name[6:].replace("_", " "): getattr(World, name)
          for name in dir(World) if name.startswith("thing_")}
LIGHTS = {name[6:].replace("_", " "): getattr(World, name)
          for name in dir(World) if name.startswith("light_")}
