"""What is measured: scenes, integrators, and where each scene's reference comes from."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Reference:
    """How the converged picture of a scene is rendered, and why so."""

    options: tuple
    method: str
    reason: str


# No curve is rendered with this alpha: the radius shrinks as passes^-1/4, against passes^-1/6 with
# the default of 2/3. With several times the passes, what blur is left is a small part of that in
# the curves. It is not nothing, and it favours the photon methods; docs/convergence/README.md says
# how to see how much.
_PHOTONS = ("-i", "sppm", "--alpha", "0.5")
_PHOTONS_METHOD = "sppm, alpha 1/2"


def _by_photons(reason):
    return Reference(_PHOTONS, _PHOTONS_METHOD, reason)


@dataclass(frozen=True)
class Scene:
    """A scene of sample_scenes/ and the size that its camera was set up for."""

    name: str
    width: int
    height: int
    reference: Reference
    options: tuple = ()
    path_misses: str = ""  # light that no path from the camera can find; "": it finds all

    def height_for(self, width):
        return max(1, round(width * self.height / self.width))


SCENES = {
    scene.name: scene
    for scene in (
        Scene(
            "caustic_box",
            512,
            512,
            _by_photons("paths find the caustics only when they happen to hit the small lamp"),
        ),
        Scene(
            "pool",
            960,
            640,
            _by_photons("the sun has no size: no path finds it through the water"),
            path_misses="sunlight through the water",
        ),
        Scene(
            "enclosed_lamp",
            800,
            600,
            _by_photons("all light has passed glass: paths must hit the small bulb by chance"),
        ),
        Scene(
            "interior",
            960,
            600,
            Reference(
                ("-i", "path"),
                "path",
                "no caustics: the path tracer converges, and it has no bias",
            ),
        ),
        Scene(
            "fog_ball",
            960,
            540,
            _by_photons("the spot lamp has no size: no path finds it through the glass"),
            options=("--fog", "0.1,0"),
            path_misses="the lamp's light through the glass ball",
        ),
        Scene(
            "prism",
            960,
            600,
            _by_photons("the spot lamp has no size: no path finds it through the prism"),
            path_misses="the spectrum",
        ),
        Scene(
            "ceramic_box",
            800,
            640,
            _by_photons("paths find the caustics only when they happen to hit the small lamp"),
        ),
        Scene(
            "glass_of_water",
            640,
            640,
            _by_photons("the spot lamp has no size: no path finds it through glass and water"),
            path_misses="the spot lamp's light through glass and water",
        ),
        Scene(
            "glass_table",
            800,
            600,
            _by_photons("the spot lamp has no size: no path finds it through the glass"),
            path_misses="the spot lamp's light through the glass",
        ),
        Scene(
            "mirrors",
            900,
            600,
            _by_photons("caustics by mirrors and glass from lamps of modest size"),
            options=("--max-depth", "256"),
        ),
    )
}
DEFAULT_SCENES = ("caustic_box", "pool", "enclosed_lamp", "interior", "fog_ball", "prism")


@dataclass(frozen=True)
class Integrator:
    """A curve: the options that select it, and how it is drawn."""

    name: str
    options: tuple
    title: str
    colour: str  # the palette of Okabe and Ito, made for all kinds of colour vision
    point: int  # gnuplot's point type


INTEGRATORS = {
    integrator.name: integrator
    for integrator in (
        Integrator("sppm", ("-i", "sppm"), "sppm", "#0072b2", 7),
        Integrator(
            "memoryless",
            ("-i", "sppm", "--schedule", "memoryless"),
            "sppm, memoryless",
            "#56b4e9",
            5,
        ),
        Integrator(
            "epochs",
            ("-i", "ppm", "--photons-per-epoch", "10000000"),
            "ppm, epochs of 10 million",
            "#009e73",
            9,
        ),
        Integrator(
            "epochs_photons",
            ("-i", "ppm", "--photons-per-epoch", "10000000", "--direct", "photons"),
            "ppm, epochs, all light by photons",
            "#000000",
            2,
        ),
        Integrator("ppm", ("-i", "ppm"), "ppm, one eye pass", "#e69f00", 11),
        Integrator("map", ("-i", "ppm", "--alpha", "1"), "photon map, fixed radius", "#cc79a7", 13),
        Integrator("path", ("-i", "path"), "path", "#d55e00", 3),
    )
}
DEFAULT_INTEGRATORS = ("sppm", "memoryless", "epochs", "path")
