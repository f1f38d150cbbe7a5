/* libppm: everything, in dependency order. */
#ifndef PPM_PPM_H
#define PPM_PPM_H

#include "ppm/asset.h"
#include "ppm/color.h"
#include "ppm/context.h"
#include "ppm/export.h"
#include "ppm/import.h"
#include "ppm/output.h"
#include "ppm/render.h"
#include "ppm/scene.h"
#include "ppm/setup.h"
#include "ppm/status.h"

#endif
