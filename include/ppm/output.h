/* Writing pictures. Files are written beside their name and renamed when complete, so that a
 * viewer may watch them and a killed process leaves nothing half-written. */
#ifndef PPM_OUTPUT_H
#define PPM_OUTPUT_H

#include "ppm/color.h"
#include "ppm/render.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { PPM_DITHER_DEFAULT = 0, PPM_DITHER_OFF = 1 }; /* the default is noise of one step */
enum { PPM_DEPTH_DEFAULT = 0, PPM_DEPTH_HALF = 1, PPM_DEPTH_FLOAT = 2 };

/* How an EXR is packed; all but DWAA, DWAB and PXR24 keep every bit. These three are for the layers
 * of light: those of other numbers are parts of their own then, packed by ZIP. */
enum {
    PPM_COMPRESSION_DEFAULT = 0, /* ZIPS */
    PPM_COMPRESSION_NONE = 1,
    PPM_COMPRESSION_RLE = 2,
    PPM_COMPRESSION_ZIPS = 3,  /* rows one by one: quick to scrub through */
    PPM_COMPRESSION_ZIP = 4,   /* 16 rows together: smaller */
    PPM_COMPRESSION_PIZ = 5,   /* wavelets: smallest for noise */
    PPM_COMPRESSION_PXR24 = 6, /* 32-bit floats lose 8 bits */
    PPM_COMPRESSION_DWAA = 7,  /* lossy, 32 rows together */
    PPM_COMPRESSION_DWAB = 8   /* lossy, 256 rows together */
};

/* 0 or NULL in any field means its default. */
typedef struct ppm_output_options {
    uint32_t size;       /* sizeof(ppm_output_options) */
    int32_t depth;       /* EXR pixels; default PPM_DEPTH_FLOAT. Layers that half floats would
                            spoil (ppm_layer_info.is_exact) are float with PPM_DEPTH_HALF too */
    float exposure_ev;   /* display-referred files: the picture times 2^EV before the view */
    const char *display; /* default: the configuration's */
    const char *view;    /* default: the display's */
    const char *command; /* for the EXR's metadata: how the picture was made; may be NULL */
    uint32_t has_frame;  /* non-zero: the EXR's header says which frame it is */
    int32_t frame;
    double frames_per_second; /* with has_frame, above 0 */
    const char *copyright;    /* for the metadata of every format; may be NULL or "" */
    const char *xmp;          /* for the EXR's metadata: about the scene, as JSON (ppm_asset_xmp) */
    int32_t compression;      /* of EXR: PPM_COMPRESSION_ */
    float compression_level;  /* of DWAA and DWAB: larger is smaller and worse; default 45 */
    uint32_t is_multipart;    /* non-zero: the EXR has a part for each layer */
    uint32_t tile_side;       /* pixels, 16 .. 4096; 0: the EXR has scanlines */
    int32_t bits;          /* of a channel of PNG and TIFF, 8 or 16; default 8 in PNG, 16 in TIFF */
    int32_t dither;        /* PPM_DITHER_; 8-bit PNG and TIFF */
    uint32_t jpeg_quality; /* 1 .. 100; default 95 */
    const char *look;      /* display-referred files: as in ppm_color_check_look */
    float gamma; /* display-referred files: to the power of 1/gamma after the view; default 1 */
    uint32_t is_picture_only; /* non-zero: the EXR has none of the session's other layers */
} ppm_output_options;

/* Whether path has an ending that can be written (.exr .png .jpg .jpeg .tif .tiff, any case) and
 * its folder takes new files. Returns OK, INVALID_ARGUMENT (ending) or OUTPUT_NOT_WRITABLE. */
PPM_API ppm_status ppm_output_check(ppm_context *context, const char *path);

/* Whether there is a whole picture at path: a file of its ending's format, with its last bytes.
 * Says nothing. out_width and out_height, of the whole picture in pixels, may be NULL. Any thread.
 */
PPM_API int32_t ppm_output_is_whole(const char *path, uint32_t *out_width, uint32_t *out_height);

/* Writes the picture so far of a session; the ending of path says the kind:
 *   .exr               scene-linear in the scene's working space, all layers of the session: the
 *                      picture as R, G, B, A, depth as Z, the others as LAYER.CHANNEL
 *                      (docs/compositing.md); the view does not apply. With a crop: its pixels are
 *                      the data window, the whole picture the display window.
 *                      Header: chromaticities, colorInteropID (of known spaces),
 *                      ppm:workingSpace, PixelAspectRatio, Software, ppm:version, ppm:options,
 *                      ppm:integrator, ppm:passes, ppm:photons, ppm:seed, ppm:camera, ppm:command;
 *                      OpenEXR's worldToCamera, worldToNDC, nominalFocalLength (mm, for a sensor of
 *                      ppm:sensor_mm), aperture, focus, screenWindowCenter, screenWindowWidth;
 *                      ppm:sceneDigest, ppm:cameraDigest, ppm:seconds; those of Cryptomatte 1.2;
 *                      with color ppm:colorConfig, ppm:display, ppm:view, ppm:look, ppm:exposure,
 *                      ppm:gamma; where given, the copyright as OpenEXR's "owner" and the scene's
 *                      metadata as ppm:xmp; of a frame ppm:frame, ppm:time (seconds),
 *                      framesPerSecond
 *   .png .jpg .tif     through exposure, look, view and gamma, in this order. The crop alone.
 *                      8 bits with dither, TIFF 16 bits, unless options say otherwise. The colour
 *                      space is tagged where the display's name tells it: PNG by cICP and sRGB or
 *                      iCCP, JPEG and TIFF by an ICC profile. Header: Software, Copyright
 * color may be NULL for .exr. options may be NULL.
 * Threads: not while another thread is in ppm_render_advance.
 * Returns OK, INVALID_ARGUMENT, NOT_FOUND (display, view), OUTPUT_NOT_WRITABLE, OUT_OF_MEMORY,
 * WRONG_STATE (no finished pass). On failure the file at path is as it was. */
PPM_API ppm_status ppm_render_write(const ppm_render *render, const ppm_color *color,
                                    const char *path, const ppm_output_options *options);

#ifdef __cplusplus
}
#endif

#endif
