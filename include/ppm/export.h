/* Marks what libppm exports. Everything else is hidden. */
#ifndef PPM_EXPORT_H
#define PPM_EXPORT_H

#if defined(__GNUC__)
#define PPM_API __attribute__((visibility("default")))
#else
#define PPM_API
#endif

#endif
