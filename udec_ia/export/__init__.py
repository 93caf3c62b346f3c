"""Files for other programs: VTKHDF for ParaView and pyvista, CSV tables, GeoJSON and SVG."""

from udec_ia.export.export_files import export

__all__ = ["export"]
