// CityGML of any producer is read: our own in both versions as it was written, others' in the forms that they have.
#include <gmock/gmock.h>

#include "base/scratch.hpp"
#include "cities.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/citygml_made_by.hpp"
#include "mansard/formats/foreign.hpp"
#include "mansard/formats/models.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/formats/vector/features.hpp"
#include "mansard/solid/solid.hpp"

namespace {

using namespace cities;
using namespace mansard;
using formats::Format;
using testing::HasSubstr;

class CityGmlRead : public testing::Test {
 protected:
  auto given(const std::string& text) -> std::filesystem::path {
    auto path = folder_ / "theirs.gml";
    EXPECT_TRUE(base::write_file(path, text));
    return path;
  }
  mansard::test::Scratch folder_;
};

auto value_of(const model::Attributes& attributes, const std::string& name) -> model::Value {
  for (const auto& [key, value] : attributes)
    if (key == name) return value;
  return {};
}

TEST_F(CityGmlRead, own_files_say_how_they_were_made_whatever_the_names_of_their_inputs) {
  City city = street();
  city.made_by.inputs = {{"a--b-->c<&>\"--", 7, std::string(64, '0')}};
  city.made_by.options = {{"ingest.where", "x < 3 -- y"}};
  const auto path = folder_ / "own.gml";
  base::Outputs outputs;
  auto writer = formats::open_writer(Format::citygml, path, {city.frame, city.made_by}, {}, outputs);
  ASSERT_TRUE(writer);
  ASSERT_TRUE(formats::write_city(city, **writer));
  ASSERT_TRUE(outputs.commit());
  const auto bytes = base::read_file(path);
  const auto start = bytes->find(formats::citygml_made_by_start), end = bytes->find(" -->", start);
  ASSERT_NE(end, std::string::npos);
  EXPECT_EQ(bytes->substr(start + 4, end - start - 4).find("--"), std::string::npos);  // no comment may have two
  const auto made_by = formats::citygml_made_by(*bytes);
  ASSERT_TRUE(made_by);
  EXPECT_EQ(made_by->version, city.made_by.version);
  EXPECT_EQ(made_by->options, city.made_by.options);
  ASSERT_EQ(made_by->inputs.size(), 1U);
  EXPECT_EQ(made_by->inputs[0].path, "a--b-->c<&>\"--");
  EXPECT_TRUE(formats::read_foreign(path));
  EXPECT_FALSE(formats::citygml_made_by("<CityModel><!-- mansard {} --></CityModel>"));
  EXPECT_FALSE(formats::citygml_made_by("<!-- mansard {\"version\": 3} --><CityModel/>"));
  // Somebody else's file that quotes it.
  const auto comment = bytes->substr(start, end + 4 - start);
  EXPECT_TRUE(
      formats::citygml_made_by("<?xml version=\"1.0\"?>\n<CityModel xmlns=\"a\">\n" + comment + "<a/></CityModel>"));
  EXPECT_FALSE(formats::citygml_made_by("<CityModel xmlns=\"a\"><b/>" + comment + "<a/></CityModel>"));
  EXPECT_FALSE(formats::citygml_made_by(comment + "<CityModel/>"));
}

TEST_F(CityGmlRead, own_files_come_back_in_both_versions) {
  for (const auto version : {formats::CityGml::v2, formats::CityGml::v3}) {
    City city = street();
    city.buildings[0].attributes = {
        {"year", std::int64_t{1893}}, {"width", 7.25}, {"owner", std::string("Müller & Söhne")}};
    formats::WriteOptions options;
    options.citygml = version;
    const auto path = folder_ / (version == formats::CityGml::v2 ? "2.gml" : "3.gml");
    base::Outputs outputs;
    auto writer = formats::open_writer(Format::citygml, path, {city.frame, city.made_by}, options, outputs);
    ASSERT_TRUE(writer);
    ASSERT_TRUE(formats::write_city(city, **writer));
    ASSERT_TRUE(outputs.commit());

    const auto read = formats::read_foreign(path);
    ASSERT_TRUE(read) << to_string(read.error());
    EXPECT_EQ(read->lods, "2");
    EXPECT_EQ(read->city.frame.crs, city.frame.crs);
    ASSERT_EQ(read->city.buildings.size(), city.buildings.size());
    for (std::size_t b = 0; b < city.buildings.size(); ++b) {
      const auto& building = read->city.buildings[b];
      EXPECT_EQ(building.id, city.buildings[b].id);
      EXPECT_EQ(building.footprint.empty(), city.buildings[b].footprint.empty());
      double volume = 0, written = 0;
      for (const auto& part : building.parts) {
        EXPECT_TRUE(solid::check(part.model.solid, {.planar = 1e-3}).empty()) << building.id;
        volume += solid::volume(part.model.solid);
      }
      for (const auto& part : city.buildings[b].parts) written += solid::volume(part.model.solid);
      EXPECT_NEAR(volume, written, 0.01 * written) << building.id;
    }
    const auto& attributes = read->city.buildings[0].attributes;
    EXPECT_EQ(value_of(attributes, "year"), model::Value(std::int64_t{1893}));
    EXPECT_EQ(value_of(attributes, "width"), model::Value(7.25));
    EXPECT_EQ(value_of(attributes, "owner"), model::Value(std::string("Müller & Söhne")));

    const auto features = formats::read_features(path, {}, {});
    ASSERT_TRUE(features) << to_string(features.error());
    EXPECT_EQ(features->features.size(), city.buildings.size());
    EXPECT_FALSE(features->crs.empty());

    const auto bytes = base::read_file(path);
    const auto model = formats::read_cityjson(*bytes, "", path.string());
    ASSERT_TRUE(model) << to_string(model.error());
    EXPECT_EQ(model->buildings.size(), city.buildings.size());
  }
}

constexpr const char* head = R"(<?xml version="1.0" encoding="UTF-8"?>
<core:CityModel xmlns:core="http://www.opengis.net/citygml/2.0" xmlns:b="http://www.opengis.net/citygml/building/2.0"
 xmlns:gml="http://www.opengis.net/gml" xmlns:gen="http://www.opengis.net/citygml/generics/2.0" xmlns:xlink="http://www.w3.org/1999/xlink">
<gml:boundedBy><gml:Envelope srsName="urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH"/></gml:boundedBy>
)";

auto polygon(const std::string& id, const std::string& places) -> std::string {
  return "<gml:Polygon gml:id=\"" + id + "\"><gml:exterior><gml:LinearRing><gml:posList srsDimension=\"3\">" + places +
         "</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>";
}

/// A box of 10 by 8 by 5 m as the German surveying authorities write it: a solid that names its surfaces, and these.
auto box() -> std::string {
  const std::array<std::pair<const char*, const char*>, 6> faces{{
      {"GroundSurface", "0 0 0 0 8 0 10 8 0 10 0 0 0 0 0"},
      {"RoofSurface", "0 0 5 10 0 5 10 8 5 0 8 5 0 0 5"},
      {"WallSurface", "0 0 0 10 0 0 10 0 5 0 0 5 0 0 0"},
      {"WallSurface", "10 0 0 10 8 0 10 8 5 10 0 5 10 0 0"},
      {"WallSurface", "10 8 0 0 8 0 0 8 5 10 8 5 10 8 0"},
      {"WallSurface", "0 8 0 0 0 0 0 0 5 0 8 5 0 8 0"},
  }};
  std::string members, bounds;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const auto id = "p" + std::to_string(i);
    members += "<gml:surfaceMember xlink:href=\"#" + id + "\"/>";
    bounds += "<b:boundedBy><b:" + std::string(faces[i].first) +
              "><b:lod2MultiSurface><gml:MultiSurface><gml:surfaceMember>" + polygon(id, faces[i].second) +
              "</gml:surfaceMember></gml:MultiSurface></b:lod2MultiSurface></b:" + faces[i].first + "></b:boundedBy>";
  }
  return "<core:cityObjectMember><b:Building gml:id=\"DEBW_1\"><gen:stringAttribute "
         "name=\"Gemeinde\"><gen:value>Ulm</gen:value>"
         "</gen:stringAttribute><b:function>31001_1000</b:function><b:measuredHeight uom=\"m\">5.0</b:measuredHeight>"
         "<b:storeysAboveGround>2</b:storeysAboveGround><b:lod2Solid><gml:Solid><gml:exterior><gml:CompositeSurface>" +
         members + "</gml:CompositeSurface></gml:exterior></gml:Solid></b:lod2Solid>" + bounds +
         "<b:address><core:Address><x>not an "
         "attribute</x></core:Address></b:address></b:Building></core:cityObjectMember>\n";
}

TEST_F(CityGmlRead, solids_find_the_surfaces_that_they_name) {
  const auto read = formats::read_foreign(given(head + box() + "</core:CityModel>"));
  ASSERT_TRUE(read) << to_string(read.error());
  ASSERT_EQ(read->city.buildings.size(), 1U);
  const auto& building = read->city.buildings[0];
  EXPECT_EQ(building.id, "DEBW_1");
  EXPECT_EQ(read->city.frame.crs, "EPSG:25832");
  ASSERT_EQ(building.parts.size(), 1U);
  const auto& model = building.parts[0].model;
  EXPECT_NEAR(solid::volume(model.solid), 400, 1e-9);
  EXPECT_TRUE(solid::check(model.solid).empty());
  EXPECT_EQ(std::ranges::count(model.classes, model::FaceClass::roof), 1);
  EXPECT_EQ(std::ranges::count(model.classes, model::FaceClass::wall), 4);
  EXPECT_EQ(value_of(building.attributes, "measuredHeight"), model::Value(5.0));
  EXPECT_EQ(value_of(building.attributes, "storeysAboveGround"), model::Value(std::int64_t{2}));
  EXPECT_EQ(value_of(building.attributes, "Gemeinde"), model::Value(std::string("Ulm")));
  EXPECT_EQ(value_of(building.attributes, "function"), model::Value(std::string("31001_1000")));
  EXPECT_EQ(building.attributes.size(), 4U);
  EXPECT_NEAR(geometry::area(building.footprint.at(0)), 80, 1e-9);
}

TEST_F(CityGmlRead, addresses_are_attributes_in_the_words_of_cityjson) {
  const std::string surface = R"(<b:lod2Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
<gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 1 0 1 1 0 1 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
<gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 1 1 0 1 1 1 1 0 1 1 0 0 1</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></b:lod2Solid>)";
  const auto read = [&](const std::string& version, const std::string& gml, const std::string& addresses) {
    return formats::read_foreign(
        given("<core:CityModel xmlns:core=\"http://www.opengis.net/citygml/" + version +
              "\" xmlns:b=\"http://www.opengis.net/citygml/building/" + version + "\" xmlns:gml=\"" + gml +
              "\" xmlns:x=\"urn:oasis:names:tc:ciq\"><core:cityObjectMember><b:Building gml:id=\"h\">" + surface +
              addresses + "</b:Building></core:cityObjectMember></core:CityModel>"));
  };
  const std::string old = R"(<b:address><core:Address><core:xalAddress><x:AddressDetails><x:Country>
<x:CountryName>Nederland</x:CountryName><x:Locality Type="Town"><x:LocalityName>Den Haag</x:LocalityName>
<x:Thoroughfare Type="Street"><x:ThoroughfareNumber>70</x:ThoroughfareNumber><x:ThoroughfareName>Spui</x:ThoroughfareName></x:Thoroughfare>
<x:PostalCode><x:PostalCodeNumber>2511 BT</x:PostalCodeNumber></x:PostalCode></x:Locality></x:Country></x:AddressDetails></core:xalAddress>
<core:multiPoint><gml:MultiPoint><gml:pos>1 2 3</gml:pos></gml:MultiPoint></core:multiPoint></core:Address></b:address>)";
  const std::string now =
      R"(<b:address><core:Address><core:xalAddress><x:Address><x:Country><x:NameElement>Nederland</x:NameElement></x:Country>
<x:Locality><x:NameElement>Den Haag</x:NameElement></x:Locality><x:Thoroughfare><x:NameElement>Spui</x:NameElement><x:Number>70</x:Number></x:Thoroughfare>
<x:PostCode><x:Identifier>2511 BT</x:Identifier></x:PostCode></x:Address></core:xalAddress></core:Address></b:address>)";
  for (const bool v3 : {false, true}) {
    const auto city = v3 ? read("3.0", "http://www.opengis.net/gml/3.2", now + now)
                         : read("2.0", "http://www.opengis.net/gml", old + old);
    ASSERT_TRUE(city) << to_string(city.error());
    const auto& attributes = city->city.buildings.at(0).attributes;
    const auto text = [](const char* words) { return model::Value(std::string(words)); };
    EXPECT_EQ(value_of(attributes, "address_Country"), text("Nederland"));
    EXPECT_EQ(value_of(attributes, "address_Locality"), text("Den Haag"));
    EXPECT_EQ(value_of(attributes, "address_ThoroughfareName"), text("Spui"));
    EXPECT_EQ(value_of(attributes, "address_ThoroughfareNumber"), text("70"));
    EXPECT_EQ(value_of(attributes, "address2_Postcode"), text("2511 BT"));
  }
}

TEST_F(CityGmlRead, files_with_a_doctype_are_refused) {
  const std::string bomb =
      "<?xml version=\"1.0\"?><!DOCTYPE x [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;\">]>"
      "<CityModel xmlns=\"http://www.opengis.net/citygml/2.0\"><x>&b;</x></CityModel>";
  const auto read = formats::read_foreign(given(bomb));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, "ingest-model-format");
  EXPECT_THAT(read.error().message, HasSubstr("DOCTYPE"));
}

TEST_F(CityGmlRead, files_that_are_cut_short_anywhere_are_refused_and_no_more) {
  const std::string whole = head + box() + "</core:CityModel>";
  for (std::size_t size = 400; size + 1 < whole.size(); size += 61) {
    const auto read = formats::read_foreign(given(whole.substr(0, size)));
    EXPECT_FALSE(read) << size;
  }
}

}  // namespace
