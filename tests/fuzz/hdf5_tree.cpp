#include "fuzz/hdf5_tree.hpp"

#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace quicksand::fuzz {

namespace {

std::size_t product(const std::vector<std::size_t>& extents) {
  std::size_t n = 1;
  for (const std::size_t e : extents) n *= e;
  return n;
}

std::vector<std::size_t> extents_of(hid_t space) {
  std::vector<hsize_t> dims(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  H5Sget_simple_extent_dims(space, dims.data(), nullptr);
  return {dims.begin(), dims.end()};
}

hid_t text_type(std::size_t length) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, std::max<std::size_t>(length, 1));
  return type;
}

hid_t make_type(const Item& item) {
  switch (item.type) {
    case ValueType::real: return H5Tcopy(H5T_NATIVE_DOUBLE);
    case ValueType::integer: return H5Tcopy(H5T_NATIVE_INT64);
    case ValueType::byte: return H5Tcopy(H5T_NATIVE_UCHAR);
    case ValueType::single: return H5Tcopy(H5T_NATIVE_FLOAT);
    case ValueType::text: return text_type(item.values.size());
    case ValueType::long_text: {
      const hid_t type = H5Tcopy(H5T_C_S1);
      H5Tset_size(type, H5T_VARIABLE);
      return type;
    }
    case ValueType::compound: {
      const hid_t type = H5Tcreate(H5T_COMPOUND, 2 * sizeof(double));
      H5Tinsert(type, "a", 0, H5T_NATIVE_DOUBLE);
      H5Tinsert(type, "b", sizeof(double), H5T_NATIVE_INT64);
      return type;
    }
  }
  return -1;
}

ValueType kind_of(hid_t type) {
  switch (H5Tget_class(type)) {
    case H5T_STRING: return ValueType::text;
    case H5T_INTEGER: return H5Tget_size(type) == 1 ? ValueType::byte : ValueType::integer;
    default: return ValueType::real;
  }
}

/// Reads a data set or an attribute by a function that takes a type and a place for the values.
template <class Read>
void read_values(Item& item, hid_t type, hid_t space, Read&& read) {
  item.type = kind_of(type);
  item.extents = extents_of(space);
  if (item.type == ValueType::text) {
    std::string text(H5Tget_size(type), '\0');
    const hid_t memory = text_type(text.size());
    read(memory, text.data());
    H5Tclose(memory);
    item.values.assign(text.begin(), text.end());
  } else {
    item.values.resize(product(item.extents));
    if (!item.values.empty()) read(H5T_NATIVE_DOUBLE, item.values.data());
  }
}

/// The values as the type wants them in memory.
std::vector<unsigned char> bytes_of(const Item& item, const std::vector<const char*>& texts) {
  const std::size_t n = product(item.extents);
  std::vector<unsigned char> bytes(std::max<std::size_t>(n, 1) * 16 + item.values.size(), 0);
  const auto value = [&](std::size_t i) { return item.values.empty() ? 0.0 : item.values[i % item.values.size()]; };
  constexpr double limit = 9e18;
  for (std::size_t i = 0; i < std::max<std::size_t>(n, 1); ++i) {
    const double x = value(i);
    const double finite = std::isnan(x) ? 0.0 : std::clamp(x, -limit, limit);
    switch (item.type) {
      case ValueType::real: reinterpret_cast<double*>(bytes.data())[i] = x; break;
      case ValueType::integer:
        reinterpret_cast<std::int64_t*>(bytes.data())[i] = static_cast<std::int64_t>(finite);
        break;
      case ValueType::byte: bytes[i] = static_cast<unsigned char>(static_cast<std::int64_t>(finite) & 255); break;
      case ValueType::single:
        reinterpret_cast<float*>(bytes.data())[i] = static_cast<float>(std::clamp(finite, -1e30, 1e30));
        break;
      case ValueType::text: break;
      case ValueType::long_text: reinterpret_cast<const char**>(bytes.data())[i] = texts.front(); break;
      case ValueType::compound: reinterpret_cast<double*>(bytes.data())[2 * i] = x; break;
    }
  }
  if (item.type == ValueType::text) {
    for (std::size_t i = 0; i < item.values.size(); ++i) {
      const double x = std::isnan(value(i)) ? 0.0 : std::clamp(value(i), -128.0, 255.0);
      bytes[i] = static_cast<unsigned char>(static_cast<std::int64_t>(x) & 255);
    }
  }
  return bytes;
}

void write_item(hid_t file, const Item& item) {
  // Extents that no memory could hold are only claimed.
  constexpr std::size_t most = 4096;
  const bool claimed = std::any_of(item.extents.begin(), item.extents.end(), [](std::size_t e) { return e > most; }) ||
                       product(item.extents) > most;
  const std::string text = "text of any length";
  const std::vector<const char*> texts{text.c_str()};
  const std::vector<hsize_t> dims(item.extents.begin(), item.extents.end());
  const hid_t type = make_type(item);
  const hid_t space = dims.empty() || item.type == ValueType::text
                          ? H5Screate(H5S_SCALAR)
                          : H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr);
  if (item.is_attribute) {
    if (!claimed && item.values.size() < most) {
      const hid_t attribute = H5Acreate2(file, item.name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT);
      if (attribute >= 0) {
        H5Awrite(attribute, type, bytes_of(item, texts).data());
        H5Aclose(attribute);
      }
    }
  } else {
    const hid_t links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    if (claimed && !dims.empty()) {
      const std::vector<hsize_t> chunk(dims.size(), 1);
      H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data());
    }
    const hid_t set = H5Dcreate2(file, item.name.c_str(), type, space, links, creation, H5P_DEFAULT);
    if (set >= 0) {
      if (!claimed) H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes_of(item, texts).data());
      H5Dclose(set);
    }
    H5Pclose(creation);
    H5Pclose(links);
  }
  H5Sclose(space);
  H5Tclose(type);
}

}  // namespace

std::vector<Item> read_tree(const std::filesystem::path& path) {
  std::vector<Item> items;
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const auto add_set = [](hid_t root, const char* name, const H5O_info_t* info, void* out) -> herr_t {
    if (info->type != H5O_TYPE_DATASET) return 0;
    Item item{name, false, ValueType::real, {}, {}};
    const hid_t set = H5Dopen2(root, name, H5P_DEFAULT);
    const hid_t type = H5Dget_type(set);
    const hid_t space = H5Dget_space(set);
    read_values(item, type, space,
                [&](hid_t memory, void* values) { H5Dread(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values); });
    H5Sclose(space);
    H5Tclose(type);
    H5Dclose(set);
    static_cast<std::vector<Item>*>(out)->push_back(std::move(item));
    return 0;
  };
  const auto add_attribute = [](hid_t root, const char* name, const H5A_info_t*, void* out) -> herr_t {
    Item item{name, true, ValueType::real, {}, {}};
    const hid_t attribute = H5Aopen(root, name, H5P_DEFAULT);
    const hid_t type = H5Aget_type(attribute);
    const hid_t space = H5Aget_space(attribute);
    read_values(item, type, space, [&](hid_t memory, void* values) { H5Aread(attribute, memory, values); });
    H5Sclose(space);
    H5Tclose(type);
    H5Aclose(attribute);
    static_cast<std::vector<Item>*>(out)->push_back(std::move(item));
    return 0;
  };
  H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, add_set, &items);
  H5Aiterate2(file, H5_INDEX_NAME, H5_ITER_INC, nullptr, add_attribute, &items);
  H5Fclose(file);
  return items;
}

void spoil(std::vector<Item>& items, Input& input) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  constexpr double values[] = {0,    -1,  1,      2,     3,      7,
                               0.5,  1e9, 4.3e9,  -5e9,  1e18,   1e300,
                               -inf, inf, 1e-300, 255.0, -1e300, std::numeric_limits<double>::quiet_NaN()};
  constexpr std::size_t sizes[] = {
      0, 1, 2, 3, 5, 8, 64, 1000, std::size_t{1} << 31, std::size_t{1} << 40, std::size_t{1} << 62};
  for (int n = 0; n < 8 && !input.empty() && !items.empty(); ++n) {
    const std::size_t at = input.below(items.size());
    Item& item = items[at];
    switch (input.below(9)) {
      case 0: items.erase(items.begin() + static_cast<std::ptrdiff_t>(at)); break;
      case 1:
        if (!item.values.empty()) item.values[input.below(item.values.size())] = values[input.below(std::size(values))];
        break;
      case 2: std::fill(item.values.begin(), item.values.end(), values[input.below(std::size(values))]); break;
      case 3: item.type = static_cast<ValueType>(input.below(value_types)); break;
      case 4:
        if (!item.extents.empty())
          item.extents[input.below(item.extents.size())] = sizes[input.below(std::size(sizes))];
        break;
      case 5: item.extents.push_back(sizes[input.below(std::size(sizes))]); break;
      case 6: item.extents.clear(); break;
      case 7: item.name = items[input.below(items.size())].name; break;
      default: {
        const std::string text = input.rest();
        item.values.assign(text.begin(), text.end());
        if (item.type != ValueType::text) item.extents = {item.values.size()};
      }
    }
  }
}

void write_tree(const std::filesystem::path& path, const std::vector<Item>& items, std::size_t front) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const hid_t creation = H5Pcreate(H5P_FILE_CREATE);
  H5Pset_userblock(creation, front);
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT);
  for (const Item& item : items) write_item(file, item);
  H5Fclose(file);
  H5Pclose(creation);
}

}  // namespace quicksand::fuzz
