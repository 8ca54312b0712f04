// Declarations of GDAL that examples/import_geotiff.cpp uses, so that it compiles where GDAL is not installed.
#pragma once

#include <string>  // as GDAL's own header does

enum GDALAccess { GA_ReadOnly };
enum GDALRWFlag { GF_Read };
enum GDALDataType { GDT_Float32 };
enum CPLErr { CE_None };

class GDALRasterBand {
  public:
    int GetXSize() const;
    int GetYSize() const;
    double GetNoDataValue(int* exists);
    double GetScale(int* exists = nullptr);
    double GetOffset(int* exists = nullptr);
    CPLErr RasterIO(GDALRWFlag, int x, int y, int width, int height, void* into, int columns, int rows, GDALDataType,
                    long long pixel_stride, long long row_stride);
};
class OGRSpatialReference {
  public:
    int IsGeographic() const;
    double GetLinearUnits(const char** name = nullptr) const;
};
class GDALDataset {
  public:
    const OGRSpatialReference* GetSpatialRef() const;
    int GetRasterCount();
    GDALRasterBand* GetRasterBand(int number);
    CPLErr GetGeoTransform(double* transform);
};
void GDALAllRegister();
void* GDALOpen(const char* path, GDALAccess);
void GDALClose(void* dataset);
