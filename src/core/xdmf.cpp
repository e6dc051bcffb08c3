#include "core/xdmf.hpp"

#include <algorithm>
#include <utility>

#include "core/atomic_file.hpp"
#include "core/hdf5_file.hpp"
#include "core/text_output.hpp"

namespace quicksand {

namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  }
  return out;
}

std::string joined(const Extents& extents) {
  std::string out;
  for (const std::size_t n : extents) out += (out.empty() ? "" : " ") + std::to_string(n);
  return out;
}

/// Reference to a dataset of doubles in a field file.
std::string data_item(const XdmfEntry& entry, const std::string& dataset, const Extents& extents) {
  return "<DataItem Format=\"HDF\" NumberType=\"Float\" Precision=\"8\" Dimensions=\"" + joined(extents) + "\">" +
         escaped(entry.file + ":/" + dataset) + "</DataItem>";
}

std::string attribute_text(const XdmfEntry& entry, const XdmfEntry::Array& field, const Extents& cells) {
  const char* type = field.components == 1 ? "Scalar" : field.components <= 3 ? "Vector" : "Matrix";
  // Viewers take only three components for a vector; of plane ones the field file holds a padded copy for them.
  const bool padded = field.components == 2;
  Extents extents = cells;
  if (field.components > 1) extents.push_back(padded ? 3 : field.components);
  return "        <Attribute Name=\"" + escaped(field.name) + "\" Center=\"Cell\" AttributeType=\"" + type +
         "\">\n          " + data_item(entry, (padded ? "viewer/" : "fields/") + field.name, extents) +
         "\n        </Attribute>\n";
}

std::string entry_text(const XdmfEntry& entry) {
  const bool planar = entry.axes.size() == 2;
  Extents points;
  Extents cells;
  for (auto axis = entry.axes.rbegin(); axis != entry.axes.rend(); ++axis) {
    points.push_back(axis->points);
    cells.push_back(axis->points - 1);
  }
  std::string out = "      <Grid Name=\"step " + std::to_string(entry.step) + "\" GridType=\"Uniform\">\n";
  out += "        <Time Value=\"" + number_text(entry.time) + "\"/>\n";
  out += std::string("        <Topology TopologyType=\"") + (planar ? "2DRectMesh" : "3DRectMesh") +
         "\" Dimensions=\"" + joined(points) + "\"/>\n";
  out += std::string("        <Geometry GeometryType=\"") + (planar ? "VXVY" : "VXVYVZ") + "\">\n";
  for (const XdmfEntry::Axis& axis : entry.axes)
    out += "          " + data_item(entry, "grid/" + axis.name, {axis.points}) + "\n";
  out += "        </Geometry>\n";
  for (const XdmfEntry::Array& field : entry.fields) out += attribute_text(entry, field, cells);
  return out + "      </Grid>\n";
}

bool is_field_file(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with("fields_") && name.ends_with(".h5");
}

}  // namespace

XdmfEntry xdmf_entry(const std::filesystem::path& field_file) {
  const Hdf5Reader file(field_file);
  XdmfEntry entry;
  entry.file = field_file.filename().string();
  entry.step = file.integer_attribute("step");
  entry.time = file.real_attribute("time");
  for (const std::string& name : file.names("grid")) entry.axes.push_back({name, count(file.extents("grid/" + name))});
  for (const std::string& name : file.names("fields")) {
    const Extents extents = file.extents("fields/" + name);
    entry.fields.push_back({name, extents.size() > entry.axes.size() ? extents.back() : 1});
  }
  return entry;
}

std::string xdmf_text(const std::vector<XdmfEntry>& entries) {
  std::string out = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<Xdmf Version=\"2.0\">\n  <Domain>\n";
  out += "    <Grid Name=\"fields\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (const XdmfEntry& entry : entries) out += entry_text(entry);
  return out + "    </Grid>\n  </Domain>\n</Xdmf>\n";
}

XdmfSeries::XdmfSeries(std::filesystem::path folder) : folder_(std::move(folder)) {
  for (const auto& item : std::filesystem::directory_iterator(folder_)) {
    if (is_field_file(item.path())) insert(xdmf_entry(item.path()));
  }
}

void XdmfSeries::add(const std::filesystem::path& field_file) {
  insert(xdmf_entry(field_file));
  write();
}

void XdmfSeries::write() const { write_text_file(folder_ / "fields.xdmf", xdmf_text(entries_)); }

void XdmfSeries::insert(const XdmfEntry& entry) {
  const auto place = std::lower_bound(entries_.begin(), entries_.end(), entry.step,
                                      [](const XdmfEntry& e, std::int64_t step) { return e.step < step; });
  if (place != entries_.end() && place->step == entry.step) {
    *place = entry;
  } else {
    entries_.insert(place, entry);
  }
}

}  // namespace quicksand
