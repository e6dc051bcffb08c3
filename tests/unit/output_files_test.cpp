// HDF5 files, field files and the time series over them.
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "core/atomic_file.hpp"
#include "core/errors.hpp"
#include "core/hdf5_file.hpp"
#include "core/snapshot.hpp"
#include "core/xdmf.hpp"
#include "unit/output_test_folder.hpp"

namespace quicksand {
namespace {

using AtomicFileTest = FolderTest;
using Hdf5Test = FolderTest;
using SnapshotTest = FolderTest;
using XdmfTest = FolderTest;

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const FileError& error) {
    return error.what();
  }
  return "no FileError";
}

/// A small planar snapshot on 3 x 2 cells.
FieldSnapshot small_snapshot(std::int64_t step) {
  FieldSnapshot snapshot{.title = "a <test> & more",
                         .units = "none",
                         .geometry = "planar",
                         .step = step,
                         .time = 0.1 * static_cast<double>(step),
                         .dt = 0.1,
                         .axes = {{"x", {0, 1, 2, 4}}, {"z", {0, 0.5, 1}}},
                         .fields = {{"phi_sand", 1, {1, 2, 3, 4, 5, 6}}, {"velocity", 2, std::vector<double>(12)}}};
  std::iota(snapshot.fields[1].values.begin(), snapshot.fields[1].values.end(), 0.0);
  return snapshot;
}

TEST_F(AtomicFileTest, AppearsOnlyWhenCommitted) {
  {
    AtomicFile file(path("a.txt"));
    std::ofstream(file.temporary()) << "half";
    EXPECT_EQ(file.temporary().parent_path(), folder_);
    EXPECT_FALSE(std::filesystem::exists(path("a.txt")));
  }
  EXPECT_EQ(files(), 0U);

  write_text_file(path("a.txt"), "first");
  {
    AtomicFile file(path("a.txt"));
    std::ofstream(file.temporary()) << "second";
    EXPECT_EQ(content(path("a.txt")), "first");
    file.commit();
  }
  EXPECT_EQ(content(path("a.txt")), "second");
  EXPECT_EQ(files(), 1U);
}

TEST_F(AtomicFileTest, NamesTheMissingFolder) {
  const std::string message = message_of([&] { write_text_file(path("none/a.txt"), "x"); });
  EXPECT_NE(message.find("none"), std::string::npos) << message;
  EXPECT_NE(message.find("does not exist"), std::string::npos) << message;
}

TEST_F(Hdf5Test, ReadsBackWhatWasWritten) {
  const std::vector<double> values{1.5, -2, 1e-300, std::numeric_limits<double>::infinity(), 5, 6};
  const std::vector<std::int64_t> integers{-1, 1LL << 60};
  const std::vector<unsigned char> bytes{0, 1, 255};
  {
    Hdf5Writer file(path("a.h5"), 4);
    file.write("deep/in/groups", values, {2, 3});
    file.write("integers", integers);
    file.write("bytes", bytes, {3});
    file.write("empty", std::vector<double>{});
    file.attribute("time", 0.1);
    file.attribute("step", std::int64_t{7});
    file.attribute("title", std::string("Grüße"));
    file.attribute("unit", std::string(""), "deep");
    file.commit();
  }
  const Hdf5Reader file(path("a.h5"));
  EXPECT_EQ(file.doubles("deep/in/groups"), values);
  EXPECT_EQ(file.extents("deep/in/groups"), (Extents{2, 3}));
  EXPECT_EQ(file.integers("integers"), integers);
  EXPECT_EQ(file.bytes("bytes"), bytes);
  EXPECT_TRUE(file.doubles("empty").empty());
  EXPECT_EQ(file.real_attribute("time"), 0.1);
  EXPECT_EQ(file.integer_attribute("step"), 7);
  EXPECT_EQ(file.text_attribute("title"), "Grüße");
  EXPECT_EQ(file.text_attribute("unit", "deep"), "");
  EXPECT_EQ(file.names("/"), (std::vector<std::string>{"bytes", "deep", "empty", "integers"}));
  EXPECT_TRUE(file.has("deep/in"));
  EXPECT_FALSE(file.has("deep/out/groups"));
  EXPECT_FALSE(file.has_attribute("dt"));
}

TEST_F(Hdf5Test, CompressedBlocksCoverLargeData) {
  const std::size_t n = 300'000;  // more than one chunk
  std::vector<double> values(n);
  for (std::size_t i = 0; i < n; ++i) values[i] = std::sin(static_cast<double>(i));
  Hdf5Writer file(path("a.h5"), 1);
  file.write("tall", values, {n, 1});
  file.write("flat", values, {2, n / 2});
  file.commit();
  EXPECT_EQ(Hdf5Reader(path("a.h5")).doubles("tall"), values);
  EXPECT_EQ(Hdf5Reader(path("a.h5")).doubles("flat"), values);
}

TEST_F(Hdf5Test, UnfinishedFileLeavesTheOldOne) {
  {
    Hdf5Writer file(path("a.h5"));
    file.write("x", std::vector<double>{1});
    file.commit();
  }
  {
    Hdf5Writer file(path("a.h5"));
    file.write("x", std::vector<double>{2});
  }
  EXPECT_EQ(Hdf5Reader(path("a.h5")).doubles("x"), (std::vector<double>{1}));
  EXPECT_EQ(files(), 1U);
}

TEST_F(Hdf5Test, ErrorsNameFileObjectAndReason) {
  const std::string missing = message_of([&] { Hdf5Reader reader(path("none.h5")); });
  EXPECT_NE(missing.find("none.h5"), std::string::npos) << missing;
  EXPECT_NE(missing.find("No such file"), std::string::npos) << missing;

  write_text_file(path("text.h5"), "this is no HDF5 file");
  EXPECT_NE(message_of([&] { Hdf5Reader reader(path("text.h5")); }).find("signature"), std::string::npos);

  write_fields(path("fields.h5"), small_snapshot(1));
  const Hdf5Reader file(path("fields.h5"));
  EXPECT_NE(message_of([&] { file.doubles("fields/phi_mud"); }).find("'fields/phi_mud'"), std::string::npos);
  EXPECT_NE(message_of([&] { file.real_attribute("weight"); }).find("'weight'"), std::string::npos);
  std::vector<double> four(4);
  EXPECT_NE(message_of([&] { file.read("fields/phi_sand", four); }).find("6 values, not 4"), std::string::npos);
}

TEST_F(SnapshotTest, ReadsBackWhatWasWritten) {
  const FieldSnapshot written = small_snapshot(12);
  write_fields(path(fields_file_name(12)), written);
  EXPECT_TRUE(std::filesystem::exists(path("fields_00000012.h5")));
  const FieldSnapshot read = read_fields(path("fields_00000012.h5"));
  EXPECT_EQ(read.title, written.title);
  EXPECT_EQ(read.units, "none");
  EXPECT_EQ(read.geometry, "planar");
  EXPECT_EQ(read.step, 12);
  EXPECT_EQ(read.time, written.time);
  EXPECT_EQ(read.dt, written.dt);
  ASSERT_EQ(read.axes.size(), 2U);
  EXPECT_EQ(read.axes[0].name, "x");
  EXPECT_EQ(read.axes[1].faces, written.axes[1].faces);
  ASSERT_EQ(read.fields.size(), 2U);
  EXPECT_EQ(read.fields[0].values, written.fields[0].values);
  EXPECT_EQ(read.fields[1].components, 2);
  EXPECT_EQ(read.fields[1].values, written.fields[1].values);
}

TEST_F(SnapshotTest, LayoutIsTheDocumentedOne) {
  write_fields(path("a.h5"), small_snapshot(0));
  const Hdf5Reader file(path("a.h5"));
  EXPECT_EQ(file.extents("/grid/x"), (Extents{4}));
  EXPECT_EQ(file.extents("/fields/phi_sand"), (Extents{2, 3}));
  EXPECT_EQ(file.extents("/fields/velocity"), (Extents{2, 3, 2}));
  EXPECT_EQ(file.extents("/viewer/velocity"), (Extents{2, 3, 3}));
  EXPECT_EQ(file.doubles("/viewer/velocity")[7], 5.0);
  EXPECT_EQ(file.doubles("/viewer/velocity")[8], 0.0);
}

TEST_F(SnapshotTest, RefusesAFieldThatDoesNotFit) {
  FieldSnapshot snapshot = small_snapshot(0);
  snapshot.fields[0].values.pop_back();
  EXPECT_NE(message_of([&] { write_fields(path("a.h5"), snapshot); }).find("phi_sand"), std::string::npos);
  EXPECT_EQ(files(), 0U);
}

TEST(Snapshot, TakesOwnedCellsInFileOrder) {
  const Grid<3> grid({{{0, 1, 2}, {0, 1, 2, 3}, {0, 1, 2}}}, Geometry::cartesian);
  CellField field(grid.layout(), -1);
  CellVectors<3> u(grid.layout(), -1);
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<3>& i) {
    field[c] = i[0] + 10 * i[1] + 100 * i[2];
    for (int d = 0; d < 3; ++d) u[d][c] = i[d];
  });
  EXPECT_EQ(owned_values(grid, field), (std::vector<double>{0, 1, 10, 11, 20, 21, 100, 101, 110, 111, 120, 121}));
  const std::vector<double> vectors = owned_values(grid, u);
  ASSERT_EQ(vectors.size(), 36U);
  EXPECT_EQ(std::vector<double>(vectors.end() - 6, vectors.end()), (std::vector<double>{0, 2, 1, 1, 2, 1}));
  const std::vector<SnapshotAxis> axes = snapshot_axes(grid);
  ASSERT_EQ(axes.size(), 3U);
  EXPECT_EQ(axes[1].name, "y");
  EXPECT_EQ(axes[1].faces.size(), 4U);
}

TEST_F(XdmfTest, SeriesFollowsTheFieldFiles) {
  for (const int step : {20, 10}) write_fields(path(fields_file_name(step)), small_snapshot(step));
  XdmfSeries(folder_).write();
  EXPECT_NE(content(path("fields.xdmf")).find("fields_00000020.h5"), std::string::npos);
  std::filesystem::remove(path(fields_file_name(20)));  // resumed at step 10
  XdmfSeries series(folder_);
  ASSERT_EQ(series.entries().size(), 1U);
  write_fields(path(fields_file_name(30)), small_snapshot(30));
  series.add(path(fields_file_name(30)));
  series.add(path(fields_file_name(30)));
  ASSERT_EQ(series.entries().size(), 2U);

  const std::string text = content(path("fields.xdmf"));
  EXPECT_NE(text.find("CollectionType=\"Temporal\""), std::string::npos);
  EXPECT_LT(text.find("fields_00000010.h5:/grid/x"), text.find("fields_00000030.h5:/grid/x"));
  EXPECT_EQ(text.find("fields_00000020.h5"), std::string::npos);
  EXPECT_NE(text.find("TopologyType=\"2DRectMesh\" Dimensions=\"3 4\""), std::string::npos);
  EXPECT_NE(text.find("Dimensions=\"2 3 3\">fields_00000010.h5:/viewer/velocity<"), std::string::npos);
}

TEST(Xdmf, IsWellFormed) {
  const XdmfEntry flat{"a&b.h5", 1, 0.5, {{"x", 3}, {"z", 4}}, {{"phi_<sand>", 1}, {"velocity", 2}}};
  const XdmfEntry solid{"c.h5", 2, 1.5, {{"x", 3}, {"y", 4}, {"z", 5}}, {{"velocity", 3}, {"stress", 6}}};
  const std::string text = xdmf_text({flat, solid});
  // Every element that opens also closes, in order.
  std::vector<std::string> open;
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    const std::size_t end = text.find('>', at);
    ASSERT_NE(end, std::string::npos);
    if (text[at + 1] == '?' || text[end - 1] == '/') continue;
    const bool closes = text[at + 1] == '/';
    const std::size_t begin = at + (closes ? 2 : 1);
    const std::string name = text.substr(begin, text.find_first_of(" >", begin) - begin);
    if (closes) {
      ASSERT_FALSE(open.empty());
      EXPECT_EQ(open.back(), name);
      open.pop_back();
    } else {
      open.push_back(name);
    }
  }
  EXPECT_TRUE(open.empty());
  EXPECT_NE(text.find("a&amp;b.h5:/fields/phi_&lt;sand&gt;"), std::string::npos);
  EXPECT_NE(text.find("TopologyType=\"3DRectMesh\" Dimensions=\"5 4 3\""), std::string::npos);
}

}  // namespace
}  // namespace quicksand
