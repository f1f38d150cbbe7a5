#!/bin/sh
# Renders the pictures of docs/compositing.md beside this script; files of layers go to out/compositing.
# Takes five minutes; wants a release build, oiiotool, Blender for the matte, and for the garden a
# latitude-longitude photograph: Poly Haven's symmetrical_garden_1k.hdr (CC0), by its path.
#
#   docs/compositing/render.sh symmetrical_garden_1k.hdr
set -eu
garden=$(realpath "$1")
cd "$(dirname "$0")/../.."
program=${PPM_RENDER:-build/release/bin/ppm-render}
here=docs/compositing
out=out/compositing
mkdir -p $out

# show FILE.exr NAME OPTION...: a scene-linear picture, changed by options of oiiotool, as a JPEG
show() {
    file=$1 name=$2
    shift 2
    oiiotool "$file" --ch R,G,B "$@" --tocolorspace sRGB --eraseattrib DateTime \
        --compression jpeg:90 -o "$here/$name.jpg"
}

# One render, taken apart.
"$program" -q -s 480x360 -n 64 --aov all --light-groups=named -o $out/table.exr sample_scenes/glass_table.glb
oiiotool $out/table.exr --ch R=caustics.R,G=caustics.G,B=caustics.B -o $out/caustics.exr
show $out/table.exr table --mulc 1.3
show $out/caustics.exr caustics --mulc 2.6

# mix NAME SPOT PANEL: the two lights, each with its colour
mix() {
    oiiotool $out/table.exr --ch R=light.Spot.R,G=light.Spot.G,B=light.Spot.B --mulc "$2" \
        $out/table.exr --ch R=light.Panel.R,G=light.Panel.G,B=light.Panel.B --mulc "$3" \
        --add -o $out/mix.exr
    show $out/mix.exr "$1" --mulc 1.3 --clamp:min=0:max=1 --resize 320x240
}
mix lights_spot 1,1,1 0,0,0
mix lights_panel 0,0,0 1,1,1
mix lights_night 0.22,0.4,0.95 2.6,1.5,0.7

# The marble, by its matte, and all else without colour.
blender --background --factory-startup --python-exit-code 1 --python $here/matte.py -- \
    $out/table.exr Marble 480 360 $out/matte.exr >$out/blender.log
show $out/matte.exr matte --resize 320x240
oiiotool $out/table.exr --ch R,G,B --dup --chsum:weight=0.21,0.72,0.07 --ch 0,0,0 --chnames R,G,B \
    $out/matte.exr --ch R,R,R --chnames R,G,B -o $out/weight.exr --pop -o $out/grey.exr --pop -o $out/colour.exr
oiiotool $out/colour.exr $out/weight.exr --mul \
    $out/weight.exr --mulc -1 --addc 1 $out/grey.exr --mul --add -o $out/marble.exr
show $out/marble.exr marble --mulc 1.3 --clamp:min=0:max=1 --resize 320x240

# Into a photograph. Its pixels are those of the environment: a garden without things in it.
"$program" -q -s 480x320 -n 16 -i path --env "$garden" --setup $here/photograph.json -o $out/photograph.exr \
    $here/garden.glb
"$program" -q -s 480x320 -n 400 -p 60k --seed 5 --env "$garden" --catcher Lawn -o $out/things.exr $here/garden.glb
oiiotool $out/things.exr --ch R,G,B,A $out/photograph.exr --ch R,G,B,A --over -o $out/garden.exr
show $out/photograph.exr photograph --mulc 1.4 --clamp:min=0:max=1 --resize 320x213
show $out/things.exr things --mulc 1.4 --clamp:min=0:max=1 --resize 320x213
show $out/garden.exr garden --mulc 1.4
