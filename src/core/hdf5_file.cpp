#include "core/hdf5_file.hpp"

#include <hdf5.h>

#include <algorithm>
#include <cassert>
#include <type_traits>
#include <utility>

#include "core/atomic_file.hpp"
#include "core/errors.hpp"

namespace quicksand {

namespace {

static_assert(std::is_same_v<std::int64_t, hid_t>, "the header keeps HDF5 handles as std::int64_t");

/// HDF5 handle that closes itself.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;
  hid_t get() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

/// Errors become exceptions; the library itself stays silent.
void silence_library() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

/// What the innermost library function complained about.
std::string library_reason() {
  std::string reason;
  const auto keep_innermost = [](unsigned n, const H5E_error2_t* error, void* out) -> herr_t {
    if (n == 0 && error->desc != nullptr) *static_cast<std::string*>(out) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_innermost, &reason);
  H5Eclear2(H5E_DEFAULT);
  return reason.empty() ? "unknown HDF5 error" : reason;
}

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw FileError(path.string() + ": cannot " + what + ": " + library_reason());
}

/// Passes a good handle or status on and throws for a negative one.
template <class T>
T checked(T result, const std::filesystem::path& path, const std::string& what) {
  if (result < 0) fail(path, what);
  return result;
}

/// Properties of access to a file. Files are ours alone while written and complete when read, so that locks, which some
/// network file systems lack, are not needed.
Handle access_properties() {
  Handle properties(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
#if H5_VERSION_GE(1, 10, 7)
  H5Pset_file_locking(properties.get(), false, true);
#endif
  H5Pset_fclose_degree(properties.get(), H5F_CLOSE_STRONG);
  return properties;
}

/// Largest chunk of a compressed dataset.
constexpr std::size_t largest_chunk_bytes = std::size_t{1} << 20;

/// Bytes of values per byte in the file: deflate comes to 1032, with filters that shuffle no more.
constexpr double largest_compression = 1100;

/// Bytes of values that are read whatever their file holds, such as those that were never written.
constexpr double smallest_dataset = 4096;

/// By how much the memory of a file that is put together grows.
constexpr std::size_t memory_increment = std::size_t{1} << 22;

/// Chunks of whole planes or rows: the slowest axes are cut first.
std::vector<hsize_t> chunk_extents(const Extents& extents, std::size_t value_bytes) {
  std::vector<hsize_t> chunk(extents.begin(), extents.end());
  std::size_t bytes = count(extents) * value_bytes;
  for (hsize_t& n : chunk) {
    if (bytes <= largest_chunk_bytes) break;
    bytes /= n;
    n = std::max<hsize_t>(1, largest_chunk_bytes / std::max<std::size_t>(1, bytes));
    bytes *= n;
  }
  return chunk;
}

Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), std::max<std::size_t>(1, length));
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

/// Makes sure that an attribute is a single value: there is room for one only.
void check_single(hid_t attribute, const std::filesystem::path& path, const std::string& what) {
  const Handle space(checked(H5Aget_space(attribute), path, what), H5Sclose);
  if (H5Sget_simple_extent_npoints(space.get()) == 1) return;
  throw FileError(path.string() + ": cannot " + what + ": it is not a single value");
}

std::string quoted(const std::string& kind, const std::string& name) { return kind + " '" + name + "'"; }

}  // namespace

std::string hdf5_version() {
  unsigned major = 0;
  unsigned minor = 0;
  unsigned release = 0;
  H5get_libversion(&major, &minor, &release);
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(release);
}

std::size_t count(const Extents& extents) {
  std::size_t n = 1;
  for (const std::size_t e : extents) n *= e;
  return n;
}

// Writer

Hdf5Writer::Hdf5Writer(const std::filesystem::path& path, int compression, std::size_t front)
    : path_(path), compression_(compression), front_(front) {
  assert(compression >= 0 && compression <= 9);
  silence_library();
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  checked(H5Pset_userblock(creation.get(), front), path, "create the file");
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  checked(H5Pset_fapl_core(access.get(), memory_increment, false), path, "create the file");
  id_ = checked(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), path, "create the file");
}

Hdf5Writer::~Hdf5Writer() {
  if (id_ >= 0) H5Fclose(id_);
}

void Hdf5Writer::write_raw(const std::string& name, const void* values, std::size_t size, std::int64_t type,
                           const Extents& extents) {
  assert(id_ >= 0 && size == count(extents));
  const std::string what = "write " + quoted("dataset", name);
  const std::vector<hsize_t> dims(extents.begin(), extents.end());
  const Handle space(
      dims.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr),
      H5Sclose);
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  checked(H5Pset_create_intermediate_group(links.get(), 1), path_, what);
  // Without times the same values make the same file.
  checked(H5Pset_obj_track_times(creation.get(), false), path_, what);
  if (compression_ > 0 && !dims.empty() && size > 0) {
    const auto chunk = chunk_extents(extents, H5Tget_size(type));
    checked(H5Pset_chunk(creation.get(), static_cast<int>(chunk.size()), chunk.data()), path_, what);
    checked(H5Pset_shuffle(creation.get()), path_, what);
    checked(H5Pset_deflate(creation.get(), static_cast<unsigned>(compression_)), path_, what);
  }
  const Handle set(
      checked(H5Dcreate2(id_, name.c_str(), type, space.get(), links.get(), creation.get(), H5P_DEFAULT), path_, what),
      H5Dclose);
  if (size > 0) checked(H5Dwrite(set.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), path_, what);
}

void Hdf5Writer::write(const std::string& name, std::span<const double> values, const Extents& extents) {
  write_raw(name, values.data(), values.size(), H5T_NATIVE_DOUBLE, extents);
}

void Hdf5Writer::write(const std::string& name, std::span<const std::int64_t> values, const Extents& extents) {
  write_raw(name, values.data(), values.size(), H5T_NATIVE_INT64, extents);
}

void Hdf5Writer::write(const std::string& name, std::span<const unsigned char> values, const Extents& extents) {
  write_raw(name, values.data(), values.size(), H5T_NATIVE_UCHAR, extents);
}

void Hdf5Writer::attribute_raw(const std::string& name, const void* value, std::int64_t type,
                               const std::string& object) {
  assert(id_ >= 0);
  const std::string what = "write " + quoted("attribute", name);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(checked(H5Acreate_by_name(id_, object.c_str(), name.c_str(), type, space.get(), H5P_DEFAULT,
                                                   H5P_DEFAULT, H5P_DEFAULT),
                                 path_, what),
                         H5Aclose);
  checked(H5Awrite(attribute.get(), type, value), path_, what);
}

void Hdf5Writer::attribute(const std::string& name, double value, const std::string& object) {
  attribute_raw(name, &value, H5T_NATIVE_DOUBLE, object);
}

void Hdf5Writer::attribute(const std::string& name, std::int64_t value, const std::string& object) {
  attribute_raw(name, &value, H5T_NATIVE_INT64, object);
}

void Hdf5Writer::attribute(const std::string& name, const std::string& value, const std::string& object) {
  attribute_raw(name, value.c_str(), text_type(value.size()).get(), object);
}

void Hdf5Writer::commit(const std::function<std::string(std::string_view)>& front) {
  assert(id_ >= 0);
  checked(H5Fflush(id_, H5F_SCOPE_LOCAL), path_, "put the file together");
  void** memory = nullptr;
  checked(H5Fget_vfd_handle(id_, H5P_DEFAULT, reinterpret_cast<void**>(&memory)), path_, "put the file together");
  // The size is that without the free bytes.
  const auto size = checked(H5Fget_file_image(id_, nullptr, 0), path_, "put the file together");
  const std::string_view content(static_cast<const char*>(*memory) + front_, static_cast<std::size_t>(size));
  write_file(path_, {front ? front(content) : std::string(front_, '\0'), content});
  checked(H5Fclose(std::exchange(id_, -1)), path_, "close the file");
}

// Reader

Hdf5Reader::Hdf5Reader(const std::filesystem::path& path) : path_(path) {
  silence_library();
  id_ = checked(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access_properties().get()), path, "open the file");
}

Hdf5Reader::~Hdf5Reader() {
  if (id_ >= 0) H5Fclose(id_);
}

bool Hdf5Reader::has(const std::string& name) const {
  // H5Lexists wants every group on the way to exist.
  for (std::size_t end = name.find('/', 1); end != std::string::npos; end = name.find('/', end + 1)) {
    if (H5Lexists(id_, name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
  }
  return name == "/" || H5Lexists(id_, name.c_str(), H5P_DEFAULT) > 0;
}

bool Hdf5Reader::has_attribute(const std::string& name, const std::string& object) const {
  return H5Aexists_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> Hdf5Reader::names(const std::string& group) const {
  std::vector<std::string> result;
  const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  checked(H5Literate_by_name(id_, group.c_str(), H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &result, H5P_DEFAULT),
          path_, "list " + quoted("group", group));
  return result;
}

Extents Hdf5Reader::extents(const std::string& name) const {
  const std::string what = "read " + quoted("dataset", name);
  const Handle set(checked(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), path_, what), H5Dclose);
  const Handle space(checked(H5Dget_space(set.get()), path_, what), H5Sclose);
  std::vector<hsize_t> dims(static_cast<std::size_t>(checked(H5Sget_simple_extent_ndims(space.get()), path_, what)));
  checked(H5Sget_simple_extent_dims(space.get(), dims.data(), nullptr), path_, what);
  return Extents(dims.begin(), dims.end());
}

std::size_t Hdf5Reader::count_stored(const std::string& name, std::size_t value_bytes) const {
  const std::string what = "read " + quoted("dataset", name);
  const Handle set(checked(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), path_, what), H5Dclose);
  // No number of values that memory could not hold is believed that the bytes in the file can't hold either.
  const double most = static_cast<double>(H5Dget_storage_size(set.get())) * largest_compression;
  double claimed = 1;
  for (const std::size_t e : extents(name)) claimed *= static_cast<double>(e);
  if (claimed * static_cast<double>(value_bytes) > most + smallest_dataset) {
    throw FileError(path_.string() + ": cannot " + what + ": it claims more values than its file holds");
  }
  return static_cast<std::size_t>(claimed);
}

void Hdf5Reader::read_raw(const std::string& name, void* values, std::size_t size, std::int64_t type) const {
  const std::string what = "read " + quoted("dataset", name);
  const std::size_t stored = count(extents(name));
  if (stored != size) {
    throw FileError(path_.string() + ": cannot " + what + ": it holds " + std::to_string(stored) + " values, not " +
                    std::to_string(size));
  }
  const Handle set(checked(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), path_, what), H5Dclose);
  if (size > 0) checked(H5Dread(set.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), path_, what);
}

void Hdf5Reader::read(const std::string& name, std::span<double> values) const {
  read_raw(name, values.data(), values.size(), H5T_NATIVE_DOUBLE);
}

std::vector<double> Hdf5Reader::doubles(const std::string& name) const {
  std::vector<double> values(count_stored(name, sizeof(double)));
  read(name, values);
  return values;
}

std::vector<std::int64_t> Hdf5Reader::integers(const std::string& name) const {
  std::vector<std::int64_t> values(count_stored(name, sizeof(std::int64_t)));
  read_raw(name, values.data(), values.size(), H5T_NATIVE_INT64);
  return values;
}

std::vector<unsigned char> Hdf5Reader::bytes(const std::string& name) const {
  std::vector<unsigned char> values(count_stored(name, sizeof(unsigned char)));
  read_raw(name, values.data(), values.size(), H5T_NATIVE_UCHAR);
  return values;
}

void Hdf5Reader::attribute_raw(const std::string& name, void* value, std::int64_t type,
                               const std::string& object) const {
  const std::string what = "read " + quoted("attribute", name);
  const Handle attribute(
      checked(H5Aopen_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), path_, what), H5Aclose);
  check_single(attribute.get(), path_, what);
  checked(H5Aread(attribute.get(), type, value), path_, what);
}

double Hdf5Reader::real_attribute(const std::string& name, const std::string& object) const {
  double value = 0;
  attribute_raw(name, &value, H5T_NATIVE_DOUBLE, object);
  return value;
}

std::int64_t Hdf5Reader::integer_attribute(const std::string& name, const std::string& object) const {
  std::int64_t value = 0;
  attribute_raw(name, &value, H5T_NATIVE_INT64, object);
  return value;
}

std::string Hdf5Reader::text_attribute(const std::string& name, const std::string& object) const {
  const std::string what = "read " + quoted("attribute", name);
  const Handle attribute(
      checked(H5Aopen_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), path_, what), H5Aclose);
  check_single(attribute.get(), path_, what);
  const Handle stored(checked(H5Aget_type(attribute.get()), path_, what), H5Tclose);
  std::string value(H5Tget_size(stored.get()), '\0');
  checked(H5Aread(attribute.get(), text_type(value.size()).get(), value.data()), path_, what);
  value.erase(std::find(value.begin(), value.end(), '\0'), value.end());
  return value;
}

}  // namespace quicksand
