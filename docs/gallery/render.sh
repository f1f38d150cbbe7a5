#!/bin/sh
# Renders the pictures of docs/gallery.md beside this script, with the statistics that the page quotes
# in out/gallery/. Takes ten minutes; wants a release build and an idle machine.
#
#   docs/gallery/render.sh          all
#   docs/gallery/render.sh prism    those whose names begin with prism
set -eu
cd "$(dirname "$0")/../.."
program=${PPM_RENDER:-build/release/bin/ppm-render}
wanted=${1-}
mkdir -p out/gallery

# render NAME OPTION...: one picture
render() {
    picture=$1
    shift
    case $picture in
    "$wanted"*) ;;
    *) return 0 ;;
    esac
    echo "$picture: ppm-render $*"
    "$program" -q -o "docs/gallery/$picture.jpg" --stats "out/gallery/$picture.json" "$@"
}

# scene NAME SIZE SMALL_SIZE OPTION...: the large picture, and one small one by each integrator
scene() {
    scene_name=$1 size=$2 small=$3
    shift 3
    model=sample_scenes/$scene_name.glb
    [ -e "$model" ] || model=sample_scenes/$scene_name.obj
    render "$scene_name" "$model" -s "$size" -t 25 "$@"
    for integrator in ppm sppm path; do
        render "${scene_name}_$integrator" "$model" -s "$small" -t 5 -i "$integrator" "$@"
    done
}

scene caustic_box 512x512 256x256
scene ceramic_box 640x512 256x205
scene pool 720x480 256x171
scene glass_of_water 512x512 256x256
scene glass_table 640x480 256x192
scene still_life 640x480 256x192
scene beach 720x450 256x160
scene enclosed_lamp 640x480 256x192
scene prism 720x450 256x160
scene mirrors 720x480 256x171 --max-depth 64
scene interior 720x450 256x160
scene fog_ball 720x405 256x144 --fog 0.1,0

# The methods side by side, for the same time.
render methods_map sample_scenes/caustic_box.glb -s 256x256 -t 12 -i ppm --alpha 1 --radius 0.02
render methods_ppm sample_scenes/caustic_box.glb -s 256x256 -t 12 -i ppm
render methods_photons sample_scenes/caustic_box.glb -s 256x256 -t 12 -i ppm --direct photons \
    --photons-per-epoch 1M
render methods_epochs sample_scenes/caustic_box.glb -s 256x256 -t 12 -i ppm --photons-per-epoch 1M
render methods_sppm sample_scenes/caustic_box.glb -s 256x256 -t 12
render methods_path sample_scenes/caustic_box.glb -s 256x256 -t 12 -i path

# What else the camera and the sky do.
render lens sample_scenes/glass_table.glb -s 480x360 -t 15 --aperture 0.5 --focus Marble
render sun sample_scenes/pool.glb -s 480x320 -t 15 --sun 40,150 --exposure -13

# A moment of an animation, with motion blur, and the layers of glTF's materials.
render turntable sample_scenes/turntable.glb -s 720x480 -n 96 --frame 5 --shutter -0.15,0.15
